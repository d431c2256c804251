// How long and how often the machine did not let the supervisor run: a pause of the supervisor is a
// pause of the fleet. Pure: takes times as arguments.
#pragma once

#include <cstdint>

#include "services/types/time.h"

namespace giveway::fleetctl {

class PauseMeter {
 public:
  // A cycle that should have lasted `meant` lasted from `from` to `to`.
  void Note(SteadyTime from, SteadyTime to, Nanoseconds meant) {
    total_ += to - from;
    const Nanoseconds late = to - from - meant;
    if (late < kLeast) return;
    ++count_;
    paused_ += late;
    longest_ = late > longest_ ? late : longest_;
  }
  std::uint64_t Count() const { return count_; }
  Nanoseconds Paused() const { return paused_; }
  Nanoseconds Longest() const { return longest_; }
  // Share of all observed time; 0 to 1.
  double Share() const { return total_.count() > 0 ? Seconds(paused_) / Seconds(total_) : 0; }

 private:
  static constexpr Nanoseconds kLeast = std::chrono::milliseconds(50);  // a tick of the fleet

  std::uint64_t count_ = 0;
  Nanoseconds paused_{0};
  Nanoseconds longest_{0};
  Nanoseconds total_{0};
};

}  // namespace giveway::fleetctl

// When the soak's own participant is deaf rather than its fleet silent: none of the vehicles that
// run is received any more, as after the files of shared memory were deleted. Only a new
// participant receives again. Pure: takes times as arguments.
#pragma once

#include <chrono>
#include <cstdint>

#include "services/types/time.h"

namespace giveway::fleetctl {

class ObserverWatch {
 public:
  // Once a turn. `heard`: a vehicle was received; `expected`: one runs. True if a
  // new participant is due.
  bool Update(SteadyTime now, bool heard, bool expected) {
    if (heard || !expected) {
      since_ = now;
      patience_ = kPatience;
    }
    if (now - since_ < patience_) return false;
    since_ = now;
    // It did not help: the fleet is silent, or a participant needs longer to find it.
    patience_ = patience_ < kMostPatience ? 2 * patience_ : patience_;
    ++count_;
    return true;
  }
  // Participants that were due.
  std::uint64_t Count() const { return count_; }

 private:
  // Vehicles send a status twice a second; `silent` is judged after 5 s.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(2);
  static constexpr Nanoseconds kMostPatience = std::chrono::seconds(30);

  SteadyTime since_{0};
  Nanoseconds patience_ = kPatience;
  std::uint64_t count_ = 0;
};

}  // namespace giveway::fleetctl

// What to log of a fault that comes back at every attempt, such as a full disk: the first at once,
// then a reminder once a minute, and that it is over. Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "services/types/time.h"

namespace giveway {

class FaultReminder {
 public:
  static constexpr Nanoseconds kPeriod = std::chrono::minutes(1);

  // An attempt at `now` failed with `fault`, or succeeded where that is empty. Returns the line to
  // log; empty: none.
  std::string Note(const std::string& fault, SteadyTime now) {
    if (fault.empty()) {
      const std::uint64_t failed = failed_;
      failed_ = 0;
      return failed == 0 ? "" : "is written again; attempts that failed: " + std::to_string(failed);
    }
    ++failed_;
    if (failed_ > 1 && now < next_) return {};
    next_ = now + kPeriod;
    return failed_ == 1 ? fault : fault + "; attempts that failed: " + std::to_string(failed_);
  }

 private:
  std::uint64_t failed_ = 0;
  SteadyTime next_{0};
};

}  // namespace giveway

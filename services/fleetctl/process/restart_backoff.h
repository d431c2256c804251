// How long a process that ended by itself waits until it is started again, as container engines
// have it: not at all at first, then longer each time that it ends soon. Pure.
#pragma once

#include <algorithm>
#include <chrono>
#include <map>

#include "services/fleetctl/process/fleet_commands.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class RestartBackoff {
 public:
  static constexpr Nanoseconds kFirst = std::chrono::milliseconds(100);  // doubles each time
  static constexpr Nanoseconds kLongest = std::chrono::seconds(30);
  // One that ended so long after its last restart starts without a wait again.
  static constexpr Nanoseconds kRanWell = std::chrono::seconds(10);

  // When to start it again that ended now.
  SteadyTime StartOf(MemberId member, SteadyTime now) {
    const auto [found, is_new] = last_.try_emplace(member);
    Last& last = found->second;
    const bool ran_well = is_new || now - last.start >= kRanWell;
    last.wait = ran_well ? Nanoseconds{0} : std::clamp(2 * last.wait, kFirst, kLongest);
    last.start = now + last.wait;
    return last.start;
  }

 private:
  struct Last {
    SteadyTime start{0};
    Nanoseconds wait{0};
  };
  std::map<MemberId, Last> last_;
};

}  // namespace giveway::fleetctl

// What went wrong around a broken promise, as a fault file of its own: what `fleetctl shrink` makes
// smaller.
#pragma once

#include <string>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// From as long before a violation as a ring holds, to a little after it.
inline constexpr double kAroundBefore_s = 60;
inline constexpr double kAroundAfter_s = 5;

// Those that were on, or started, around `time_s`; with the times they had. Pure.
faults::Schedule Around(const faults::Schedule& schedule, double time_s);

// Reads a report folder, writes FOLDER/around.textproto around its first violation, and prints the
// line that shrinks it. The exit code: 0, or 2 where there is no violation. Throws InputError.
int WriteAround(const std::string& folder);

}  // namespace giveway::fleetctl

// The faults around a broken promise, as a fault file of its own: the input of `fleetctl shrink`.
#pragma once

#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// From one ring's length before a violation to a little after it.
inline constexpr double kAroundBefore_s = 60;
inline constexpr double kAroundAfter_s = 5;

// Those that were active, or started, around `time_s`; with their original times. `as_observed`:
// the report's list, which says when a fault really started. Pure.
faults::Schedule Around(const faults::Schedule& schedule, const std::vector<SoakFault>& as_observed,
                        double time_s);

// Reads a report folder, writes FOLDER/around.textproto around its first violation, and prints the
// command that shrinks it. The exit code: 0, or 2 if there is no violation. Throws InputError.
int WriteAround(const std::string& folder);

}  // namespace giveway::fleetctl

// Which processes of a run may end when, and what in their logs is an error. Pure.
#pragma once

#include <string_view>

#include "services/fleetctl/process/fleet_processes.h"

namespace giveway::fleetctl {

// Whether the run continues without it. In a closed fleet only after a planned end; in an open one
// without any vehicle, as long as `any_vehicle` runs.
bool MayEndEarly(const MemberEnd& end, bool open, bool any_vehicle);

// Bad is a signal that was not planned, or an exit code other than 0 of a vehicle of a closed
// fleet: the world's code carries the verdict.
bool IsGoodEnd(const MemberEnd& end, bool open);

// A line of a log that reports an error.
bool IsErrorLine(std::string_view line);

}  // namespace giveway::fleetctl

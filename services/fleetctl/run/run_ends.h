// Which processes of a run may end when, and which of their log lines are errors. Pure.
#pragma once

#include <string_view>

#include "services/fleetctl/process/fleet_processes.h"

namespace giveway::fleetctl {

// Whether the run continues without it. In a closed fleet only after a planned end; in an open one
// without any vehicle, as long as `any_vehicle` runs.
bool MayEndEarly(const MemberEnd& end, bool open, bool any_vehicle);

// Bad is an unplanned signal, or an exit code other than 0 of a vehicle of a closed fleet: the
// world's code is the verdict.
bool IsGoodEnd(const MemberEnd& end, bool open);

// Whether one that was asked to stop has left in good order. The world's exit code 1 is its
// verdict; a discovery server is another's program, which the SIGTERM that asks it may end.
bool HasLeft(const MemberEnd& end);

// Whether a process with this end is restarted if the operator wants that: one that was ended by a
// signal, or that ended itself to be restarted. Not one that is done, or could not start, and at
// most kMostRestarts times.
inline constexpr unsigned kMostRestarts = 10;
bool IsToComeBack(const MemberEnd& end, unsigned restarts);

// Whether a log line reports an error.
bool IsErrorLine(std::string_view line);

}  // namespace giveway::fleetctl

// The exit codes of every verb besides 0: 1 is a verdict (failed, found something, differs).
#pragma once

namespace giveway::fleetctl {

// Wrong arguments, bad input, or nothing could be run. There is no verdict.
inline constexpr int kCouldNotRun = 2;

}  // namespace giveway::fleetctl

// Resumes a soak whose supervisor or machine died: what was observed up to then is saved atomically
// in the report folder, and a new fleet continues with the rest of the schedule.
#pragma once

#include <string>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/fleetctl/soak/verb/soak_faults.h"

namespace giveway::fleetctl {

// In the report folder: the world's, while it runs.
inline constexpr const char* kCheckpointFile = "world.checkpoint";

// Replaces what was saved before with the JSON of a SoakResult. Returns the reason of a failure, as
// on a full disk; empty: none.
std::string SaveSoFar(const std::string& so_far, const std::string& folder);
// It has reached its verdict: there is nothing to continue.
void ForgetSoFar(const std::string& folder);
// What an earlier soak left in the folder: its state, its world's, and its report. Another soak
// must neither continue from it nor seem to have its verdict.
void ForgetSoak(const std::string& folder);
// Throws InputError if the folder has no soak that can be resumed.
SoakResult LoadSoFar(const std::string& folder);

// The faults left after the leg that died, in the time of a new fleet, whose own warm-up is
// `warm_up_s`. Those that would start before the end of the warm-up are added to `lost`, and those
// that a world whose time lagged had still to carry out. Pure.
faults::Schedule RestOf(const faults::Schedule& whole, const SoakResult& so_far, double warm_up_s,
                        SkippedFaults* lost);

// Merges both, in the times of the whole; `rest` started at so_far.ran_s. Pure.
SoakResult Joined(const SoakResult& so_far, const SoakResult& rest);

}  // namespace giveway::fleetctl

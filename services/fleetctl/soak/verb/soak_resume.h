// Resumes a soak whose supervisor or machine died: what was observed up to then is saved atomically
// in the report folder, and a new fleet continues with the rest of the schedule.
#pragma once

#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// Replaces what was saved before. Why it could not, as on a full disk; empty: it could.
std::string SaveSoFar(const SoakResult& so_far, const std::string& folder);
// It has come to its verdict: there is nothing to continue with.
void ForgetSoFar(const std::string& folder);
// Throws InputError where the folder holds no soak that could be resumed.
SoakResult LoadSoFar(const std::string& folder);

// Of the whole list what is left after `from_s`, by the clock of a new fleet, whose own warm-up is
// `warm_up_s`. What would start before that is over comes to `lost`, in words. Pure.
faults::Schedule RestOf(const faults::Schedule& whole, double from_s, double warm_up_s,
                        std::vector<std::string>* lost);

// Both as one, whose times are those of the whole; `rest` started at so_far.ran_s. Pure.
SoakResult Joined(const SoakResult& so_far, const SoakResult& rest);

}  // namespace giveway::fleetctl

// What a world starts from: its flags, the faults planned for it, and the checkpoint that is there
// where it is of the same scenario.
#pragma once

#include "services/config/flags.h"
#include "services/types/scenario.h"
#include "services/world_node/world_loop.h"

namespace giveway {

// The faults of the list that the flags name; none without one. Throws InputError.
sim::FaultSchedule LoadSchedule(const ServiceFlags& flags, const Scenario& scenario);

// Reads the checkpoint; the log says whether it resumes from it, and why not. The caller fills in
// the rest of the loop's options.
WorldLoopOptions LoopOptionsOf(const ServiceFlags& flags, const Scenario& scenario);

}  // namespace giveway

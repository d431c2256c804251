// What a world starts from: its flags, and the checkpoint that is there where it is of the same
// scenario.
#pragma once

#include "services/config/flags.h"
#include "services/types/scenario.h"
#include "services/world_node/world_loop.h"

namespace giveway {

// Reads the checkpoint; the log says whether it goes on from it, and why not. What else the loop
// works with is the caller's.
WorldLoopOptions LoopOptionsOf(const ServiceFlags& flags, const Scenario& scenario);

}  // namespace giveway

// A soak in virtual time: the same fleet of brains, the same list of faults as far as a virtual run
// can inject them, and the same verdict, in a fraction of the time and bit for bit reproducible.
// What only processes have is not judged: detection by the middleware, resources, pauses.
#pragma once

#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_seen.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// An open fleet after `count` vehicles have joined: the first to join gets the first place.
Scenario WithPlacesFilled(Scenario scenario, std::uint32_t count);

// `scenario` names all of its vehicles. Ends early if the operator interrupts it.
SoakSeen RunSoakVirtually(const Scenario& scenario, const faults::Schedule& schedule,
                          const SoakPhases& phases);

}  // namespace giveway::fleetctl

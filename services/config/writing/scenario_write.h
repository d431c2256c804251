// Writes a scenario as a file: what generators make and `fleetctl shrink` leaves of it. All of it
// but its own list of faults, which no Scenario holds.
#pragma once

#include <string>

#include "services/types/scenario.h"

namespace giveway {

// The scenario as a file, below `comment` (without the marks).
std::string WriteScenario(const Scenario& scenario, const std::string& comment);

// The scenario as it reads back, with seed 0: the last digit of an angle may differ. Throws
// InputError where a scenario that was made breaks a rule of those that are read.
Scenario ReadBack(const Scenario& scenario);

}  // namespace giveway

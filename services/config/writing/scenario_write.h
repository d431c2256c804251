// Writes a scenario as a file: what generators make and `fleetctl shrink` leaves of it.
#pragma once

#include <string>

#include "services/types/scenario.h"

namespace giveway {

// The scenario as a file that reads back as the same, below `comment` (without the marks). Throws
// InputError where it holds what is not written: places, obstacles, doors, signals, and profiles
// other than the P3-DX's.
std::string WriteScenario(const Scenario& scenario, const std::string& comment);

// The values as a file holds them: millimetres, thousandths of degrees and of metres a second.
Scenario RoundedAsWritten(Scenario scenario);

}  // namespace giveway

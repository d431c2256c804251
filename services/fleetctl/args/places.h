// How many vehicles a scenario has places for, held against what a command line asks for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/types/scenario.h"

namespace giveway::fleetctl {

// Nothing happens where `vehicles` was not given. Throws InputError where the scenario names all of
// its vehicles, or has fewer places. `file` is for the message.
void RefuseVehiclesWithoutPlace(const std::string& file, std::optional<std::uint32_t> vehicles,
                                const Scenario& scenario);

}  // namespace giveway::fleetctl

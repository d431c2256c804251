// Compares how many vehicles a scenario has places for with what a command line asks for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/types/scenario.h"

namespace giveway::fleetctl {

// Does nothing if `vehicles` was not given. Throws InputError if the scenario names all of its
// vehicles, or has fewer places. `file` is for the message.
void RefuseVehiclesWithoutPlace(const std::string& file, std::optional<std::uint32_t> vehicles,
                                const Scenario& scenario);

}  // namespace giveway::fleetctl

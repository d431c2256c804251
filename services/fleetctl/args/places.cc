#include "services/fleetctl/args/places.h"

#include <cstddef>

#include "services/config/problem.h"

namespace giveway::fleetctl {

void RefuseVehiclesWithoutPlace(const std::string& file, std::optional<std::uint32_t> vehicles,
                                const Scenario& scenario) {
  if (!vehicles) return;
  const std::size_t places = scenario.spawns.size();
  if (places == 0) {
    throw InputError(
        {{file, 0, "", "", "--vehicles was given, but the scenario names all of its vehicles",
          "leave --vehicles out, or write spawn { ... } in the scenario"}});
  }
  if (*vehicles <= places) return;
  throw InputError({{file, 0, "--vehicles", std::to_string(*vehicles),
                     "it has places for " + std::to_string(places),
                     "ask for no more, or write more spawn { ... } in the scenario"}});
}

}  // namespace giveway::fleetctl

// What the command line changes in a scenario, and what its seed does.
#pragma once

#include <cstdint>
#include <optional>

#include "services/types/scenario.h"

namespace giveway {

// Absent: the scenario stays as the file says.
struct ScenarioOverrides {
  std::optional<std::uint32_t> seed;
  std::optional<Behaviour> behaviour;
  std::optional<double> duration_s;
};

// The pure half: moves start poses by up to 0.05 m and 2 degrees and cruise by up to 2 %, from
// scenario.seed. Seed 0 moves nothing. Each vehicle has its own stream.
void PerturbBySeed(Scenario* scenario);

}  // namespace giveway

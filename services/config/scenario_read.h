// A parsed scenario file as a Scenario. Finds every problem it can; the Scenario is meant for use
// only if there was none.
#pragma once

#include <optional>
#include <vector>

#include "services/config/scenario_overrides.h"
#include "services/config/section.h"
#include "services/faults/fault_file.h"
#include "services/types/scenario.h"

namespace giveway {

struct ReadScenario {
  Scenario scenario;
  std::optional<faults::FaultFile> faults;
  // Where scenario.vehicles[i] and so on were written.
  std::vector<Section> vehicles;
  std::vector<Section> spawns;
  std::vector<Section> obstacles;
  std::vector<Section> doors;
  std::vector<Section> one_lanes;
};

// `root` is of the message giveway.schema.Scenario. Problems go to `root`.
ReadScenario ReadFrom(const Section& root, const ScenarioOverrides& overrides);

}  // namespace giveway

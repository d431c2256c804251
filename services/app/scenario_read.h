// A parsed scenario file as a Scenario. Finds every problem it can; the Scenario is meant for use
// only if there was none.
#pragma once

#include <vector>

#include "services/app/scenario_file.h"
#include "services/app/section.h"
#include "services/types/scenario.h"

namespace giveway::app {

struct ReadScenario {
  Scenario scenario;
  std::vector<Section> vehicles;  // where scenario.vehicles[i] was written
};

// `root` is of the message giveway.schema.Scenario. Problems go to `root`.
ReadScenario ReadFrom(const Section& root, const ScenarioOverrides& overrides);

// Each vehicle clear of the walls, of its own goal and of every other: at most one problem a
// vehicle and kind. `cause` begins the message, e.g. "with seed 7 ".
void CheckStarts(const ReadScenario& read, const std::string& cause);

}  // namespace giveway::app

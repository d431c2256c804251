// A parsed scenario file as a Scenario. Finds every problem it can; the Scenario is meant for use
// only if there was none.
#pragma once

#include <vector>

#include "services/app/scenario_file.h"
#include "services/app/section.h"
#include "services/types/scenario.h"

namespace giveway::app {

inline constexpr int kMaxVehicles = 16384;  // with the spawn places
inline constexpr Allowed kWholeNumber{0, 4294967295.0};
inline constexpr Allowed kDuration{0, 86400, "s", true};

struct ReadScenario {
  Scenario scenario;
  // Where scenario.vehicles[i] and so on were written.
  std::vector<Section> vehicles;
  std::vector<Section> spawns;
  std::vector<Section> obstacles;
  std::vector<Section> doors;
};

// `root` is of the message giveway.schema.Scenario. Problems go to `root`.
ReadScenario ReadFrom(const Section& root, const ScenarioOverrides& overrides);

// Vehicles, spawn places and obstacles clear of each other, of the walls and of the doorways, and
// each vehicle outside its own goal: at most one problem a body and kind. Bodies and walls may be
// as many as a file holds. `cause` begins the message, e.g. "with seed 7 ".
void CheckStarts(const ReadScenario& read, const std::string& cause);

}  // namespace giveway::app

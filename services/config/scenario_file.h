// Loads and validates a scenario file. Protobuf text in, a Scenario out, or every problem found.
#pragma once

#include <string>

#include "services/config/scenario_overrides.h"
#include "services/types/scenario.h"

namespace giveway {

// Reads `path` (a file, or the name of a shipped scenario without folder and ending), validates it
// and applies the overrides; the seed moves start poses and cruise speeds. Throws InputError.
Scenario LoadScenario(const std::string& path, const ScenarioOverrides& overrides);

}  // namespace giveway

// Loads and validates a scenario file. Protobuf text in, a Scenario out, or every problem found.
#pragma once

#include <optional>
#include <string>

#include "services/config/scenario_overrides.h"
#include "services/faults/fault_file.h"
#include "services/types/scenario.h"

namespace giveway {

// Reads `path` (a file, or the name of a shipped scenario without folder and ending), validates it
// and applies the overrides; the seed moves start poses and cruise speeds. Throws InputError.
Scenario LoadScenario(const std::string& path, const ScenarioOverrides& overrides);

// The same of a text that is in no file; problems name it `name`.
Scenario ParseScenario(const std::string& name, const std::string& text);

// A scenario and its own list of faults, for those that carry faults out. The list is checked by
// LoadScenario too, which leaves it out.
struct ScenarioWithFaults {
  Scenario scenario;
  std::optional<faults::FaultFile> faults;  // absent: it says nothing of faults
};
ScenarioWithFaults LoadScenarioWithFaults(const std::string& path,
                                          const ScenarioOverrides& overrides);

}  // namespace giveway

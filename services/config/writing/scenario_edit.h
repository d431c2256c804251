// A scenario file with a few of its values changed, as text: for running a fleet differently from
// its file, with every process reading the same. The caller decides what for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/scenario.h"

namespace giveway {

struct ScenarioEdit {
  std::optional<double> duration_s;
  std::optional<std::uint32_t> start_with;
  bool keep_impairment = true;
  bool keep_faults = true;            // the list `faults`
  std::vector<PlannedFault> kills{};  // in addition to the planned ones; with at_s
};

// Reads `path` as LoadScenario does. Throws InputError.
std::string EditScenario(const std::string& path, const ScenarioEdit& edit);

}  // namespace giveway

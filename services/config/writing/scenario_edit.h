// A scenario file with a few values of its own changed, as text: to run a fleet another
// way than its file says and wants every process to read the same. What it is for is the caller's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace giveway {

struct ScenarioEdit {
  std::optional<double> duration_s;
  std::optional<std::uint32_t> start_with;
  bool keep_impairment = true;
};

// Reads `path` as LoadScenario does. Throws InputError.
std::string EditScenario(const std::string& path, const ScenarioEdit& edit);

}  // namespace giveway

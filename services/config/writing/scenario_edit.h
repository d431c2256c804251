// A scenario file with a few of its values changed, as text: for running a fleet differently from
// its file, with every process reading the same. The caller decides what for.
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

// Scenario files for the tests of config: a folder that vanishes, and a good text to corrupt.
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "services/config/problem.h"
#include "services/config/scenario_overrides.h"

namespace giveway {

// A folder of its own, removed with everything in it.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::string& Path() const { return path_; }
  // Writes a file and gives its path.
  std::string Write(const std::string& name, std::string_view text) const;

 private:
  std::string path_;
};

// Two vehicles, a wall, a fault and an expectation, all valid; tests rely on the line numbers.
extern const std::string kGoodScenario;

// kGoodScenario with `from`, which occurs once, replaced.
std::string Edited(std::string_view from, std::string_view to);
Scenario Load(const std::string& text, const ScenarioOverrides& overrides = {});
// Problems of a scenario text; empty if it loads.
std::vector<Problem> ProblemsOf(const std::string& text, const ScenarioOverrides& overrides = {});

// For the messages of failed tests.
inline void PrintTo(const Problem& problem, std::ostream* out) { *out << Format({problem}); }

}  // namespace giveway

// Loads and validates a scenario file. Protobuf text in, a Scenario out, or every problem found.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::app {

// One thing wrong with an input file, in words an operator can act on.
struct Problem {
  std::string file;
  int line = 0;         // 1-based; 0 where the file as a whole is meant
  std::string field;    // path, e.g. "vehicle[1].cruise_m_s"; empty for the file as a whole
  std::string value;    // as written; empty if missing
  std::string message;  // what is wrong and the allowed range
  std::string remedy;   // what to do
};

// "file:line: field = value: message; remedy", one a line.
std::string Format(const std::vector<Problem>& problems);

// Start-up input is bad. what() lists every problem. Main exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  const std::vector<Problem>& Problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// What the command line changes in a scenario.
struct ScenarioOverrides {
  std::optional<std::uint32_t> seed;
  std::optional<Behaviour> behaviour;
  std::optional<double> duration_s;
};

// Reads `path` (a file, or the name of a shipped scenario without folder and ending), validates it
// and applies the overrides; the seed moves start poses and cruise speeds. Throws InputError.
Scenario LoadScenario(const std::string& path, const ScenarioOverrides& overrides);

// The scenario as a file that reads back as the same, below `comment` (without the marks). Throws
// InputError where it holds what is not written: places, obstacles, doors, signals, and profiles
// other than the P3-DX's.
std::string WriteScenario(const Scenario& scenario, const std::string& comment);

// The values as a file holds them: millimetres, thousandths of degrees and of metres a second.
Scenario RoundedAsWritten(Scenario scenario);

// The pure half: moves start poses by up to 0.05 m and 2 degrees and cruise by up to 2 %, from
// scenario.seed. Seed 0 moves nothing. Each vehicle has its own stream.
void PerturbBySeed(Scenario* scenario);

// The file a scenario argument means: itself if it exists, else the shipped one of that name.
// Throws InputError naming both places and listing the shipped scenarios.
std::string ResolveScenario(const std::string& argument);

// The folder holding qos/ and scenarios/: $GIVEWAY_CONFIG_DIR, else beside the installed binary
// (../share/giveway), else the source tree the binary was built in. Throws InputError.
std::string ConfigDir();

}  // namespace giveway::app

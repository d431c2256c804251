#include "services/app/scenario_file.h"

#include <fmt/format.h>

#include "scenario.pb.h"
#include "services/app/scenario_read.h"
#include "services/app/section.h"
#include "services/app/text_file.h"

namespace giveway::app {
namespace {

void ThrowIfAny(const Section& root) {
  std::vector<Problem> problems = root.Problems();
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

Scenario LoadScenario(const std::string& path, const ScenarioOverrides& overrides) {
  const std::string file = ResolveScenario(path);
  const Section root = ParseText(file, ReadTextFile(file), schema::Scenario::default_instance());
  ReadScenario read = ReadFrom(root, overrides);
  ThrowIfAny(root);
  PerturbBySeed(&read.scenario);
  CheckStarts(read, fmt::format("with seed {} ", read.scenario.seed));
  ThrowIfAny(root);
  return read.scenario;
}

}  // namespace giveway::app

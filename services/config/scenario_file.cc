#include "services/config/scenario_file.h"

#include <fmt/format.h>

#include "scenario.pb.h"
#include "services/config/braking_rules.h"
#include "services/config/config_dir.h"
#include "services/config/problem.h"
#include "services/config/scenario_read.h"
#include "services/config/section.h"
#include "services/config/start_rules.h"
#include "services/config/text_file.h"

namespace giveway {
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
  CheckStarts(read, "");
  CheckBraking(read);
  ThrowIfAny(root);
  PerturbBySeed(&read.scenario);
  CheckStarts(read, fmt::format("with seed {} ", read.scenario.seed));
  ThrowIfAny(root);
  return read.scenario;
}

}  // namespace giveway

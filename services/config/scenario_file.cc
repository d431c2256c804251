#include "services/config/scenario_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "scenario.pb.h"
#include "services/config/braking_rules.h"
#include "services/config/config_dir.h"
#include "services/config/faults/faults_file.h"
#include "services/config/plan_read.h"
#include "services/config/problem.h"
#include "services/config/scenario_read.h"
#include "services/config/section.h"
#include "services/config/start_rules.h"
#include "services/config/text_file.h"
#include "services/faults/expand.h"

namespace giveway {
namespace {

// What its own list cannot be with this fleet, however long the run: nothing random is drawn. A
// list with bad numbers is not looked at.
std::vector<Problem> ProblemsOfFaults(const ReadScenario& read, const std::vector<Problem>& known) {
  const auto is_of_list = [](const Problem& problem) {
    return problem.field.starts_with("faults");
  };
  if (!read.faults || std::ranges::any_of(known, is_of_list)) return {};
  constexpr double kAnyLength_s = 2 * faults::kLongestRun_s;
  const faults::Course course{
      .duration_s = kAnyLength_s, .warm_up_s = kAnyLength_s, .healing_s = 0};
  const KnownIds ids = IdsOf(read.scenario);
  std::vector<VehicleId> fleet(ids.vehicles.begin(), ids.vehicles.end());
  fleet.insert(fleet.end(), ids.joining.begin(), ids.joining.end());
  return ProblemsOf(*read.faults, faults::Expand(*read.faults, course, fleet));
}

void ThrowIfAny(std::vector<Problem> problems) {
  if (!problems.empty()) throw InputError(std::move(problems));
}

// In order of lines.
std::vector<Problem> AllProblems(const Section& root, const ReadScenario& read) {
  std::vector<Problem> problems = root.Problems();
  const std::vector<Problem> of_faults = ProblemsOfFaults(read, problems);
  if (of_faults.empty()) return problems;
  problems.insert(problems.end(), of_faults.begin(), of_faults.end());
  std::ranges::stable_sort(problems, {}, &Problem::line);
  return problems;
}

ScenarioWithFaults Parse(const std::string& file, const std::string& text,
                         const ScenarioOverrides& overrides) {
  const Section root = ParseText(file, text, schema::Scenario::default_instance());
  ReadScenario read = ReadFrom(root, overrides);
  if (read.faults) read.faults->name = file;
  CheckStarts(read, "");
  CheckBraking(read);
  ThrowIfAny(AllProblems(root, read));
  PerturbBySeed(&read.scenario);
  CheckStarts(read, fmt::format("with seed {} ", read.scenario.seed));
  ThrowIfAny(root.Problems());
  return {std::move(read.scenario), std::move(read.faults)};
}

}  // namespace

Scenario ParseScenario(const std::string& name, const std::string& text) {
  return Parse(name, text, {}).scenario;
}

Scenario LoadScenario(const std::string& path, const ScenarioOverrides& overrides) {
  return LoadScenarioWithFaults(path, overrides).scenario;
}

ScenarioWithFaults LoadScenarioWithFaults(const std::string& path,
                                          const ScenarioOverrides& overrides) {
  const std::string file = ResolveScenario(path);
  return Parse(file, ReadTextFile(file), overrides);
}

}  // namespace giveway

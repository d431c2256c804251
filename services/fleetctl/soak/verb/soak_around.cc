#include "services/fleetctl/soak/verb/soak_around.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include "services/config/faults/faults_file.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/faults/schedule_text.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/fleetctl/soak/soak_session.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

constexpr double kLookOn_s = 20;  // a shrunk run continues for this long

SoakResult ReadResult(const std::string& folder) {
  ReadSoak read = ReadSoakReport(folder);
  if (read.complaint.empty()) return std::move(read.result);
  throw InputError({{.file = folder,
                     .field = "--around",
                     .value = folder,
                     .message = read.complaint,
                     .remedy = "name a folder that fleetctl soak --report wrote"}});
}

}  // namespace

// What the world carries out starts later than planned where its time stood.
faults::Schedule Around(const faults::Schedule& schedule, const std::vector<SoakFault>& as_observed,
                        double time_s) {
  std::map<std::pair<std::string, std::uint32_t>, double> started_s;
  for (const SoakFault& fault : as_observed) started_s[{fault.rule, fault.nth}] = StartOf(fault);
  faults::Schedule around;
  std::ranges::copy_if(schedule, std::back_inserter(around), [&](const faults::Fault& fault) {
    const auto started = started_s.find({fault.rule, fault.nth});
    const double at_s = started == started_s.end() ? fault.at_s : started->second;
    const bool lasts =
        fault.kind == faults::Kind::kKill || at_s + fault.for_s >= time_s - kAroundBefore_s;
    return at_s <= time_s + kAroundAfter_s && lasts;
  });
  return around;
}

int WriteAround(const std::string& folder) {
  const SoakResult result = ReadResult(folder);
  if (result.violations.empty()) {
    std::fprintf(stderr, "%s: no promise was broken\n", folder.c_str());
    return kCouldNotRun;
  }
  const SoakViolation& first = result.violations.front();
  const std::string scenario_file = (fs::path(folder) / "scenario.textproto").string();
  const auto seed = static_cast<std::uint32_t>(result.seed);
  const Scenario scenario = LoadScenario(scenario_file, {seed, std::nullopt, std::nullopt});
  const auto named = static_cast<std::uint32_t>(scenario.vehicles.size());
  const std::uint32_t newcomers = result.vehicles - std::min(result.vehicles, named);
  const std::vector<VehicleId> fleet = SoakFleet(scenario, newcomers);
  const faults::Course course{seed, result.planned_s, 0, 0};
  const std::string faults_file = (fs::path(folder) / "faults.textproto").string();
  const faults::Schedule all = LoadAndExpandFaults(faults_file, course, fleet).schedule;
  const faults::Schedule around = Around(all, result.faults, first.time_s);
  const std::string file = (fs::path(folder) / "around.textproto").string();
  WriteFile(file, faults::AsTextproto(around));
  fmt::print("{} of {} faults are around {} at {:.1f} s: {}\n", around.size(), all.size(),
             first.invariant, first.time_s, file);
  fmt::print("fleetctl shrink {}{} --seed {} --duration {:.0f} --faults {} --skip-unsupported\n",
             scenario_file,
             scenario.spawns.empty() ? "" : fmt::format(" --vehicles {}", result.vehicles), seed,
             first.time_s + kLookOn_s, file);
  return 0;
}

}  // namespace giveway::fleetctl

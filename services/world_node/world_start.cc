#include "services/world_node/world_start.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "services/config/config_dir.h"
#include "services/config/faults/faults_file.h"
#include "services/faults/expand.h"
#include "services/runtime/process.h"
#include "services/runtime/state_file.h"
#include "services/types/state_hash.h"

namespace giveway {
namespace {

// Of everything that makes the scenario: the file as it is, and what the flags change in it.
std::uint64_t MarkOf(const ServiceFlags& flags, const Scenario& scenario) {
  StateHash hash;
  const auto file = ReadStateFile(ResolveScenario(flags.scenario));
  for (const char byte : file.value_or("")) hash.Add(static_cast<std::uint64_t>(byte));
  if (!flags.faults.empty()) {
    for (const char byte : ReadStateFile(ResolveFaults(flags.faults)).value_or("")) {
      hash.Add(static_cast<std::uint64_t>(byte));
    }
  }
  hash.Add(scenario.seed);
  hash.Add(scenario.duration_s);
  hash.Add(flags.behaviour.has_value());
  if (flags.behaviour) hash.Add(*flags.behaviour);
  return hash.Value();
}

// The state to resume from, or none; the log says which, and why.
std::optional<sim::FleetCheckpoint> ReadCheckpoint(const std::string& file, std::uint64_t mark) {
  const std::optional<std::string> bytes = ReadStateFile(file);
  if (!bytes) {
    LogInfo("no checkpoint in " + file + ": starts a new run");
    return std::nullopt;
  }
  auto checkpoint = sim::FromBytes(*bytes);
  std::string fault;
  if (const std::string* why = std::get_if<std::string>(&checkpoint)) {
    fault = *why;
  } else if (std::get<sim::FleetCheckpoint>(checkpoint).scenario != mark) {
    fault = "it is of another scenario";
  }
  if (fault.empty()) return std::get<sim::FleetCheckpoint>(std::move(checkpoint));
  LogWarning("the checkpoint in " + file + " is of no use: " + fault + "; starts a new run");
  return std::nullopt;
}

}  // namespace

// Random draws depend on the fleet and the course of the run, and every process that carries out
// the list must draw the same.
sim::FaultSchedule LoadSchedule(const ServiceFlags& flags, const Scenario& scenario) {
  sim::FaultSchedule schedule{.seed = scenario.seed};
  if (flags.faults.empty()) return schedule;
  const faults::FaultFile file = LoadFaults(flags.faults);
  std::vector<Problem> problems;
  for (const faults::RandomRule& rule : file.random) {
    problems.push_back({.file = file.name,
                        .line = rule.line,
                        .field = "random",
                        .value = rule.name,
                        .message = "the world takes a list in which nothing is random",
                        .remedy = "give it what fleetctl faults expand prints"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  faults::Course course{.seed = scenario.seed, .healing_s = 0};
  std::set<VehicleId> vehicles;
  for (const VehicleOptions& vehicle : scenario.vehicles) vehicles.insert(vehicle.id);
  for (const faults::AtRule& rule : file.at) {
    course.duration_s = std::max(course.duration_s, rule.time_s + rule.for_s);
    // Any id may join an open fleet.
    if (sim::IsOpen(scenario)) vehicles.insert(rule.target.vehicle);
    if (sim::IsOpen(scenario)) vehicles.insert(rule.parameters.from.value_or(kNoVehicle));
  }
  vehicles.erase(kNoVehicle);
  const std::vector<VehicleId> ids(vehicles.begin(), vehicles.end());
  faults::Expansion expansion = faults::Expand(file, course, ids);
  problems = ProblemsOf(file, expansion);
  if (!problems.empty()) throw InputError(std::move(problems));
  schedule.faults = std::move(expansion.schedule);
  return schedule;
}

WorldLoopOptions LoopOptionsOf(const ServiceFlags& flags, const Scenario& scenario) {
  WorldLoopOptions options{.lockstep = flags.lockstep,
                           .checkpoint_file = flags.checkpoint,
                           .scenario_mark = MarkOf(flags, scenario),
                           .checkpoint = {},
                           .same_epoch = !flags.go_on_from.empty()};
  const std::string& file = options.same_epoch ? flags.go_on_from : flags.checkpoint;
  if (!file.empty()) options.checkpoint = ReadCheckpoint(file, options.scenario_mark);
  return options;
}

}  // namespace giveway

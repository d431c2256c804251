#include "services/world_node/world_start.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "services/config/config_dir.h"
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
  hash.Add(scenario.seed);
  hash.Add(scenario.duration_s);
  hash.Add(flags.behaviour.has_value());
  if (flags.behaviour) hash.Add(*flags.behaviour);
  return hash.Value();
}

// The state to go on from, or none; the log says which, and why.
std::optional<sim::FleetCheckpoint> ReadCheckpoint(const std::string& file, std::uint64_t mark) {
  const std::optional<std::string> bytes = ReadStateFile(file);
  if (!bytes) {
    LogInfo("no checkpoint in " + file + ": starts anew");
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
  LogWarning("the checkpoint in " + file + " is of no use: " + fault + "; starts anew");
  return std::nullopt;
}

}  // namespace

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

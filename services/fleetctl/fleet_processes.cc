#include "services/fleetctl/fleet_processes.h"

#include <fmt/format.h>

#include <csignal>

namespace giveway::fleetctl {
namespace {

std::vector<std::string> SharedFlags(const RunOptions& options, const FleetCommand& command) {
  std::vector<std::string> flags{
      "--scenario",  command.scenario_file, "--domain", std::to_string(command.domain),
      "--interface", options.interface,     "--qos",    command.qos_file,
      "--log-level", options.log_level};
  const auto add = [&flags](const char* flag, std::string value) {
    flags.emplace_back(flag);
    flags.push_back(std::move(value));
  };
  if (options.seed) add("--seed", std::to_string(*options.seed));
  if (options.behaviour) add("--behaviour", std::string(Name(*options.behaviour)));
  if (options.duration_s) add("--duration", fmt::format("{}", *options.duration_s));
  if (options.lockstep) flags.emplace_back("--lockstep");
  return flags;
}

std::string LogFile(const RunOptions& options, const std::string& name) {
  if (options.logs_folder.empty()) return {};
  return (std::filesystem::path(options.logs_folder) / (name + ".log")).string();
}

}  // namespace

std::vector<ChildCommand> MakeCommands(const RunOptions& options, const FleetCommand& command,
                                       const Scenario& scenario) {
  const std::vector<std::string> flags = SharedFlags(options, command);
  const auto make = [&](const std::string& name, const char* program, const std::string& log) {
    ChildCommand child{name,
                       {(command.program_folder / program).string()},
                       LogFile(options, log),
                       command.lock_fd};
    child.words.insert(child.words.end(), flags.begin(), flags.end());
    return child;
  };
  std::vector<ChildCommand> commands{make("the world", "giveway-world", "world")};
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    const std::string id = std::to_string(Number(vehicle.id));
    commands.push_back(make("vehicle " + id, "giveway-vehicle", "vehicle-" + id));
    commands.back().words.insert(commands.back().words.end(), {"--id", id});
  }
  return commands;
}

FleetProcesses::FleetProcesses(const std::vector<ChildCommand>& commands,
                               const Scenario& scenario) {
  for (const ChildCommand& command : commands) children_.emplace_back(command);
  for (const VehicleOptions& vehicle : scenario.vehicles) vehicles_.push_back(vehicle.id);
}

void FleetProcesses::Poll() {
  for (ChildProcess& child : children_) child.Poll();
}

void FleetProcesses::Kill(VehicleId vehicle) {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (vehicles_[i] != vehicle) continue;
    ChildProcess& child = children_[i + 1];
    // One that is already gone died of something else: that stays unplanned.
    child.Poll();
    if (child.IsRunning()) killed_.insert(&child);
    child.Signal(SIGKILL);
  }
}

const ChildProcess* FleetProcesses::FirstUnplannedEnd() const {
  for (const ChildProcess& child : children_) {
    if (!child.IsRunning() && !killed_.contains(&child)) return &child;
  }
  return nullptr;
}

const ChildProcess* FleetProcesses::FirstBadEnd() const {
  for (const ChildProcess& child : children_) {
    if (child.IsRunning() || killed_.contains(&child)) continue;
    const bool is_world = &child == &children_.front();
    if (child.End()->by_signal || (!is_world && child.End()->number != 0)) return &child;
  }
  return nullptr;
}

bool FleetProcesses::AnyRunning() const {
  for (const ChildProcess& child : children_) {
    if (child.IsRunning()) return true;
  }
  return false;
}

void FleetProcesses::SignalAll(int signal_number) {
  for (ChildProcess& child : children_) child.Signal(signal_number);
}

}  // namespace giveway::fleetctl

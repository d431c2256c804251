#include "services/fleetctl/run/fleet_processes.h"

#include <fmt/format.h>

#include <algorithm>
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
  if (!options.discovery_servers.empty()) {
    add("--discovery-server", ToText(options.discovery_servers));
  }
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

// As runtime/log.cc writes them: "12:00:00.000 error   vehicle 2: ...", or an object.
bool IsErrorLine(std::string_view line) {
  constexpr std::size_t kTimeChars = 12;
  if (line.starts_with('{')) return line.find("\"level\":\"error\"") != std::string_view::npos;
  return line.size() > kTimeChars && line.substr(kTimeChars).starts_with(" error ");
}

std::uint32_t NewcomerCount(const RunOptions& options, const Scenario& scenario) {
  if (scenario.spawns.empty()) return 0;
  if (options.vehicles) return *options.vehicles;
  const auto named = static_cast<std::uint32_t>(scenario.vehicles.size());
  if (scenario.start_with == 0) return static_cast<std::uint32_t>(scenario.spawns.size());
  return scenario.start_with - std::min(named, scenario.start_with);
}

std::vector<ChildCommand> MakeCommands(const RunOptions& options, const FleetCommand& command,
                                       const Scenario& scenario) {
  const std::vector<std::string> flags = SharedFlags(options, command);
  const auto make = [&](const std::string& name, const char* program, const std::string& log) {
    ChildCommand child{name,
                       {(command.program_folder / program).string()},
                       LogFile(options, log),
                       command.lock_fd};
    child.flags_only = command.flags_only;
    child.words.insert(child.words.end(), flags.begin(), flags.end());
    return child;
  };
  std::vector<ChildCommand> commands{make("the world", "giveway-world", "world")};
  const auto add_vehicle = [&](const std::string& kind, const std::string& number) {
    const std::string file = kind + "-" + number;
    commands.push_back(make(kind + " " + number, "giveway-vehicle", file));
    std::vector<std::string>& words = commands.back().words;
    if (!options.impair.empty()) words.insert(words.end(), {"--impair", options.impair});
    if (options.record_folder.empty()) return;
    const auto record = std::filesystem::path(options.record_folder) / (file + ".recording");
    words.insert(words.end(), {"--record", record.string()});
    if (!options.record_split.empty()) {
      words.insert(words.end(), {"--record-split", options.record_split});
    }
  };
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    const std::string id = std::to_string(Number(vehicle.id));
    add_vehicle("vehicle", id);
    commands.back().words.insert(commands.back().words.end(), {"--id", id});
  }
  for (std::uint32_t i = 1; i <= NewcomerCount(options, scenario); ++i) {
    add_vehicle("newcomer", std::to_string(i));
  }
  return commands;
}

FleetProcesses::FleetProcesses(const std::vector<ChildCommand>& commands, const Scenario& scenario)
    : open_(!scenario.spawns.empty()) {
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
  const auto ended = [this](const ChildProcess& child) {
    return !child.IsRunning() && !killed_.contains(&child);
  };
  const auto first = std::ranges::find_if(children_, ended);
  if (first == children_.end()) return nullptr;
  const bool any_vehicle = std::any_of(children_.begin() + 1, children_.end(),
                                       [](const ChildProcess& child) { return child.IsRunning(); });
  return open_ && first != children_.begin() && any_vehicle ? nullptr : &*first;
}

std::vector<const ChildProcess*> FleetProcesses::TakeNewlyEnded() {
  std::vector<const ChildProcess*> ended;
  for (const ChildProcess& child : children_) {
    const bool is_world = &child == &children_.front();
    if (!open_ || is_world || child.IsRunning() || !told_ended_.insert(&child).second) continue;
    ended.push_back(&child);
  }
  return ended;
}

const ChildProcess* FleetProcesses::FirstBadEnd() const {
  for (const ChildProcess& child : children_) {
    if (child.IsRunning() || killed_.contains(&child)) continue;
    const bool is_world = &child == &children_.front();
    if (open_ && !is_world) continue;
    if (child.End()->by_signal || (!is_world && child.End()->number != 0)) return &child;
  }
  return nullptr;
}

std::vector<std::string> FleetProcesses::TakeErrors() {
  std::vector<std::string> errors;
  for (ChildProcess& child : children_) {
    const bool is_well = child.IsRunning() || child.End() == ProcessEnd{false, 0};
    for (const std::string& line : child.TakeLines()) {
      if (is_well && IsErrorLine(line)) errors.push_back(line);
    }
  }
  return errors;
}

bool FleetProcesses::AnyRunning() const {
  for (const ChildProcess& child : children_) {
    if (child.IsRunning()) return true;
  }
  return false;
}

void FleetProcesses::AskAllToStop() {
  for (ChildProcess& child : children_) child.AskToStop();
}

void FleetProcesses::SignalAll(int signal_number) {
  for (ChildProcess& child : children_) child.Signal(signal_number);
}

}  // namespace giveway::fleetctl

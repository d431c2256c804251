#include "services/fleetctl/stopwatch/stopwatch_fleet.h"

#include <algorithm>
#include <csignal>

#include "services/config/scenario_file.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/run/fleet_processes.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

// What is told carries its own time: nothing is lost by reading it a little later.
constexpr Nanoseconds kTurn = std::chrono::milliseconds(10);
constexpr Nanoseconds kGrace = std::chrono::seconds(2);

std::string LossOf(const ChildProcess& gone) {
  std::string text = gone.Name() + " ended unasked: " + Describe(*gone.End());
  for (const std::string& line : gone.LastLines()) text += "\n  " + line;
  return text;
}

}  // namespace

StopwatchFleet::StopwatchFleet(const StopwatchFleetCommand& command,
                               std::span<const VehicleId> fleet,
                               const std::map<VehicleId, std::string>& impair)
    : lock_(std::nullopt) {
  RunOptions options;
  options.interface = command.interface;
  options.logs_folder = command.logs_folder;
  options.vehicles = 0;  // that nobody named
  const Scenario scenario = LoadScenario(command.scenario_file, {});
  std::vector<ChildCommand> commands =
      MakeCommands(options,
                   {command.program_folder, command.scenario_file, lock_.Domain(), command.qos_file,
                    lock_.Fd(), true},
                   scenario);
  world_ = std::make_unique<ChildProcess>(commands.front());
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    ChildCommand& child = commands[i + 1];
    child.hands_on_lines = true;
    child.words.insert(child.words.end(), {"--log-format", "json", "--hang-on-signal"});
    const auto rules = impair.find(fleet[i]);
    if (rules != impair.end() && !rules->second.empty()) {
      child.words.insert(child.words.end(), {"--impair", rules->second});
    }
    auto process = std::make_unique<ChildProcess>(child);
    vehicles_.emplace(fleet[i], Vehicle{std::move(child), std::move(process)});
  }
}

StopwatchFleet::~StopwatchFleet() {
  const auto signal_all = [this](int number) {
    world_->Signal(number);
    for (auto& [id, vehicle] : vehicles_) vehicle.process->Signal(number);
  };
  signal_all(SIGCONT);
  signal_all(SIGTERM);
  const SteadyTime limit = SteadyNow() + kGrace;
  while (AnyRunning() && SteadyNow() < limit && Interrupts::Count() < 2) Turn();
}

void StopwatchFleet::Turn() {
  SleepUntil(SteadyNow() + kTurn);
  Poll();
}

void StopwatchFleet::Poll() {
  world_->Poll();
  for (auto& [id, vehicle] : vehicles_) {
    vehicle.process->Poll();
    for (const std::string& line : vehicle.process->TakeLines()) {
      const std::optional<Word> word = WordOf(line);
      if (!word) continue;
      if (word->kind == WordKind::kBlackoutsCount) blackouts_since_[id] = word->at;
      hearing_.Fold(id, *word);
      said_.push_back({id, *word});
    }
  }
}

bool StopwatchFleet::AnyRunning() const {
  return world_->IsRunning() || std::ranges::any_of(vehicles_, [](const auto& entry) {
           return entry.second.process->IsRunning();
         });
}

std::optional<SteadyTime> StopwatchFleet::BlackoutsSince(VehicleId vehicle) const {
  const auto since = blackouts_since_.find(vehicle);
  if (since == blackouts_since_.end()) return std::nullopt;
  return since->second;
}

void StopwatchFleet::Signal(VehicleId vehicle, int signal_number) {
  vehicles_.at(vehicle).process->Signal(signal_number);
}

void StopwatchFleet::Restart(VehicleId vehicle) {
  Vehicle& restarted = vehicles_.at(vehicle);
  hearing_.Restart(vehicle);
  restarted.process.reset();
  if (const std::string& log = restarted.command.log_file; !log.empty()) {
    restarted.command.log_file = log.substr(0, log.rfind(".log")) + "+.log";
  }
  restarted.process = std::make_unique<ChildProcess>(restarted.command);
}

std::optional<std::string> StopwatchFleet::Loss(std::span<const VehicleId> struck) const {
  if (!world_->IsRunning()) return LossOf(*world_);
  for (const auto& [id, vehicle] : vehicles_) {
    const bool expected = std::ranges::find(struck, id) != struck.end();
    if (!vehicle.process->IsRunning() && !expected) return LossOf(*vehicle.process);
  }
  return std::nullopt;
}

}  // namespace giveway::fleetctl

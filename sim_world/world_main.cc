// giveway-world: the shared simulated world as a process.
//
//   WorldLink::TakeCommands -> sim::Run::Advance -> WorldLink::SendScan, SendTruth, SendEvent
//
// Waits for the roster, runs the scenario on absolute deadlines, and tells everyone why it ended.
#include <map>
#include <vector>

#include "services/app/process.h"
#include "services/app/scenario_file.h"
#include "services/link/world_link.h"
#include "services/service_main.h"
#include "sim_world/reaction.h"
#include "sim_world/roster.h"
#include "sim_world/run.h"

namespace giveway {
namespace {

constexpr Nanoseconds kLockstepPatience = std::chrono::seconds(1);
constexpr Nanoseconds kFlushTimeout = std::chrono::milliseconds(500);

// What the world last heard of one vehicle.
struct Hearing {
  Tick answered = kNoTick;
  std::uint32_t matched_peers = 0;
  bool waited_for = true;  // in lockstep: until it lets a tick go by unanswered
};

class WorldLoop {
 public:
  WorldLoop(const Scenario& scenario, link::WorldLink* link, bool lockstep)
      : scenario_(scenario),
        link_(*link),
        lockstep_(lockstep),
        epoch_{app::RandomNonZero()},
        roster_(scenario_, epoch_),
        run_(scenario_, epoch_),
        start_by_(app::SteadyNow() + FromSeconds(scenario_.start_timeout_s)) {}

  // Runs to the end. True if everything expected came true.
  bool Drive(const app::StopSignal& stop) {
    app::Ticker ticker(scenario_.tick_period);
    while (run_.State() != RunState::kEnded) {
      const std::uint32_t missed = ticker.Wait();
      if (run_.State() == RunState::kRunning) overruns_ += missed;
      if (lockstep_) AwaitAnswers();
      if (stop.IsSet()) run_.End("interrupted");
      Tick();
    }
    return TellTheEnd();
  }

 private:
  void Tick() {
    Admit();
    const auto commands = link_.TakeCommands();
    const SteadyTime now = app::SteadyNow();
    commands_.insert(commands_.end(), commands.begin(), commands.end());
    for (const MotorCommand& command : commands_) {
      Hearing& hearing = heard_[command.vehicle];
      hearing = {command.tick, command.matched_peers, true};
      reactions_.Applied(command, now);
    }
    if (run_.State() == RunState::kWaiting) StartIfReady();
    run_.Advance(commands_);
    commands_.clear();
    Publish();
  }

  void Publish() {
    if (run_.State() == RunState::kRunning) {
      reactions_.Published(run_.Now(), app::SteadyNow());
    }
    for (const RangeScan& scan : run_.Scans()) link_.SendScan(scan);
    for (const Truth& truth : run_.Truths()) link_.SendTruth(truth);
    for (const WorldEvent& event : run_.Events()) link_.SendEvent(event);
  }

  // Answers everyone who asks to join.
  void Admit() {
    for (const JoinRequest& request : link_.TakeJoins()) {
      const RosterEntry entry = roster_.Admit(request);
      link_.SendRoster(entry);
      if (!entry.accepted) {
        app::LogWarning("refused a vehicle: " + entry.reason);
        continue;
      }
      if (!entries_.contains(entry.vehicle)) {
        link_.OpenRanges(entry.vehicle);
        run_.Join(entry.vehicle);
      }
      entries_[entry.vehicle] = entry;
    }
  }

  // Everyone is here, matched with the world, and matched with every other vehicle's beacons.
  bool IsReady(VehicleId vehicle) const {
    const auto hearing = heard_.find(vehicle);
    return hearing != heard_.end() && link_.IsMatched(vehicle) &&
           hearing->second.matched_peers + 1 >= scenario_.vehicles.size();
  }

  void StartIfReady() {
    std::string missing;
    for (const VehicleOptions& vehicle : scenario_.vehicles) {
      if (IsReady(vehicle.id)) continue;
      missing += (missing.empty() ? "" : " ") + std::to_string(Number(vehicle.id));
    }
    if (missing.empty()) {
      run_.Start();
      TellRunState(RunState::kRunning, "");
      app::LogInfo("started with " + std::to_string(scenario_.vehicles.size()) + " vehicles");
    } else if (app::SteadyNow() > start_by_) {
      run_.End("start_timeout: not joined and matched in time: " + missing);
    }
  }

  // Lockstep: the tick goes on when everyone who still answers has answered it.
  void AwaitAnswers() {
    const SteadyTime give_up = app::SteadyNow() + kLockstepPatience;
    while (Unanswered() && app::SteadyNow() < give_up) {
      if (!link_.WaitForCommands(give_up - app::SteadyNow())) break;
      for (const MotorCommand& command : link_.TakeCommands()) {
        heard_[command.vehicle] = {command.tick, command.matched_peers, true};
        commands_.push_back(command);
      }
    }
    for (auto& [vehicle, hearing] : heard_) hearing.waited_for = hearing.answered == run_.Now();
  }

  bool Unanswered() const {
    for (const auto& [vehicle, hearing] : heard_) {
      if (hearing.waited_for && hearing.answered != run_.Now()) return true;
    }
    return false;
  }

  void TellRunState(RunState state, const std::string& reason) {
    for (auto& [vehicle, entry] : entries_) {
      entry.run_state = state;
      entry.reason = reason;
      link_.SendRoster(entry);
    }
  }

  bool TellTheEnd() {
    RunFigures figures = run_.Figures();
    figures.tick_overruns = overruns_;
    const sim::ReactionFigures reactions = reactions_.Figures();
    figures.reactions = reactions.count;
    figures.reaction_p50_ms = reactions.p50_ms;
    figures.reaction_p99_ms = reactions.p99_ms;
    figures.reaction_max_ms = reactions.max_ms;
    link_.SendFigures(figures);
    TellRunState(RunState::kEnded, run_.EndReason());
    link_.Flush(kFlushTimeout);
    app::LogInfo("ended: " + run_.EndReason() + "; " +
                 (figures.passed ? "passed" : "failed: " + figures.reason));
    return figures.passed;
  }

  const Scenario& scenario_;
  link::WorldLink& link_;
  const bool lockstep_;
  const WorldEpoch epoch_;
  sim::Roster roster_;
  sim::Run run_;
  sim::ReactionMeter reactions_;
  const SteadyTime start_by_;
  std::map<VehicleId, RosterEntry> entries_;
  std::map<VehicleId, Hearing> heard_;
  std::vector<MotorCommand> commands_;
  std::uint32_t overruns_ = 0;
};

int RunWorld(const app::ServiceFlags& flags, const app::StopSignal& stop) {
  app::InitLog("world", flags.log_format, flags.log_level);
  const Scenario scenario = app::LoadScenario(
      flags.scenario,
      {.seed = flags.seed, .behaviour = flags.behaviour, .duration_s = flags.duration_s});
  link::WorldLink link(LinkOptionsOf(flags, scenario));
  return WorldLoop(scenario, &link, flags.lockstep).Drive(stop) ? 0 : 1;
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  return giveway::ServiceMain(giveway::app::ParseWorldFlags(argc, argv), giveway::RunWorld);
}

// giveway-vehicle: one vehicle, one process, one participant.
//
//   VehicleLink::Take -> Inputs -> Vehicle::Step -> Outputs -> VehicleLink::Send
//
// The loop wakes on its own ranges, or when the next beacon is due without them. This file only
// wires; deciding is services/vehicle, talking is services/link.
#include <algorithm>
#include <optional>

#include "services/app/process.h"
#include "services/app/scenario_file.h"
#include "services/link/vehicle_link.h"
#include "services/service_main.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/vehicle.h"
#include "services/vehicle_report.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kJoinPoll = milliseconds(20);
constexpr Nanoseconds kJoinReminder = std::chrono::seconds(5);
constexpr Nanoseconds kStatusPeriod = milliseconds(200);
constexpr Nanoseconds kFlushTimeout = milliseconds(300);
constexpr int kGoodByes = 3;  // best effort: one may be lost

// Asks the world for a place and waits for its answer. Empty if asked to stop meanwhile.
std::optional<RosterEntry> Join(link::VehicleLink* link, const app::StopSignal& stop,
                                VehicleId wanted) {
  JoinRequest request{.wanted = wanted};
  for (std::uint32_t& word : request.session) word = app::RandomNonZero();
  link->SendJoin(request);
  SteadyTime remind = app::SteadyNow() + kJoinReminder;
  while (!stop.IsSet()) {
    if (auto entry = link->TakeRoster(request.session)) return entry;
    app::SleepUntil(app::SteadyNow() + kJoinPoll);
    if (app::SteadyNow() < remind) continue;
    app::LogWarning("no answer from a world yet: is giveway-world running in this domain?");
    remind += kJoinReminder;
  }
  return std::nullopt;
}

VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry) {
  const auto found =
      std::find_if(scenario.vehicles.begin(), scenario.vehicles.end(),
                   [&entry](const VehicleOptions& options) { return options.id == entry.vehicle; });
  if (found == scenario.vehicles.end()) {
    throw link::LinkError("the world gave this vehicle an id its scenario does not have: " +
                          std::to_string(Number(entry.vehicle)) +
                          "; start both with the same scenario file");
  }
  VehicleOptions options = *found;
  options.start_world = entry.start_world;
  return options;
}

// The loop and what it must remember between two turns.
class Loop {
 public:
  Loop(link::VehicleLink* link, const VehicleOptions& options, const SessionId& session,
       bool lockstep)
      : link_(*link),
        options_(options),
        session_(session),
        lockstep_(lockstep),
        vehicle_(options, app::RandomNonZero()) {}

  // Until the run has ended or `stop` is set. Says good-bye in the second case.
  void Drive(const app::StopSignal& stop) {
    while (!stop.IsSet() && !RunEnded()) Turn(false);
    for (int i = 0; stop.IsSet() && i < kGoodByes; ++i) Turn(true);
    report_.SendFinal(vehicle_, link_);
    link_.FlushStatus(kFlushTimeout);
  }

 private:
  bool RunEnded() {
    const auto entry = link_.TakeRoster(session_);
    return entry && entry->run_state == RunState::kEnded;
  }

  // A scan is awaited half a period longer than it should take; blind, beacons keep their rate.
  Nanoseconds Patience() const {
    const bool blind = app::SteadyNow() - last_scan_ > options_.ranges_age_limit;
    const Nanoseconds due = last_beacon_ + options_.tick_period * (blind ? 2 : 3) / 2;
    return std::max(Nanoseconds{0}, due - app::SteadyNow());
  }

  void Turn(bool leaving) {
    const bool woken = link_.WaitForScan(leaving ? Nanoseconds{0} : Patience());
    const SteadyTime woke = app::SteadyNow();
    link::Taken taken = link_.Take(woke);
    Inputs& inputs = taken.inputs;
    inputs.leaving = leaving;
    if (inputs.scan) last_scan_ = woke;
    if (lockstep_ && !leaving && !KeepWorldTime(&inputs)) return;

    const SteadyTime before = app::SteadyNow();
    Outputs outputs = vehicle_.Step(inputs);
    const SteadyTime after = app::SteadyNow();
    outputs.command.matched_peers = link_.Counters().matched_peers;
    link_.Send(outputs);
    last_beacon_ = woke;
    report_.NoteStep(after - before, woken ? app::SteadyNow() - woke : Nanoseconds{0});
    if (outputs.decision_changed) app::LogInfo(Describe(outputs.command.decision));
    if (outputs.decision_changed || woke >= next_status_) {
      report_.Send(vehicle_, link_);
      next_status_ = woke + kStatusPeriod;
    }
  }

  // In lockstep the only clock is the world's tick: the run repeats whatever the machine does, so
  // nothing that depends on this machine's clock may come in. False if there is no new tick.
  bool KeepWorldTime(Inputs* inputs) {
    for (const ReceivedBeacon& beacon : inputs->beacons) held_.push_back(beacon);
    if (!inputs->scan) return false;
    inputs->now = Number(inputs->scan->tick) * options_.tick_period;
    for (ReceivedBeacon& beacon : held_) {
      beacon.received =
          std::max(inputs->now, Number(After(beacon.beacon.tick, 1)) * options_.tick_period);
    }
    in_lockstep_.swap(held_);
    held_.clear();
    inputs->beacons = in_lockstep_;
    inputs->events = {};
    return true;
  }

  link::VehicleLink& link_;
  const VehicleOptions options_;
  const SessionId session_;
  const bool lockstep_;
  Vehicle vehicle_;
  VehicleReport report_;
  SteadyTime last_scan_{0};
  SteadyTime last_beacon_{0};
  SteadyTime next_status_{0};
  std::vector<ReceivedBeacon> held_;
  std::vector<ReceivedBeacon> in_lockstep_;
};

int Run(const app::ServiceFlags& flags, const app::StopSignal& stop) {
  const std::string name = flags.id == 0 ? "vehicle" : "vehicle " + std::to_string(flags.id);
  app::InitLog(name, flags.log_format, flags.log_level);
  const Scenario scenario = app::LoadScenario(
      flags.scenario,
      {.seed = flags.seed, .behaviour = flags.behaviour, .duration_s = flags.duration_s});
  link::VehicleLink link(LinkOptionsOf(flags, scenario));
  const auto entry = Join(&link, stop, VehicleId{flags.id});
  if (!entry) return 0;
  if (!entry->accepted) {
    app::LogError("the world refused this vehicle: " + entry->reason);
    return 2;
  }
  const VehicleOptions options = OptionsOf(scenario, *entry);
  link.Open(options.id);
  Loop(&link, options, entry->session, flags.lockstep).Drive(stop);
  return 0;
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  return giveway::ServiceMain(giveway::app::ParseVehicleFlags(argc, argv), giveway::Run);
}

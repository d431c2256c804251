// giveway-vehicle: one vehicle, one process, one participant.
//
//   VehicleLink::Take -> Inputs -> Vehicle::Step -> Outputs -> VehicleLink::Send
//
// The loop wakes on its own ranges, or when the next beacon is due without them. This file only
// wires; deciding is services/vehicle, talking is services/link.
#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "services/app/hang_signal.h"
#include "services/app/process.h"
#include "services/app/recorder.h"
#include "services/app/scenario_file.h"
#include "services/beacon_news.h"
#include "services/link/vehicle_link.h"
#include "services/service_main.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/vehicle.h"
#include "services/vehicle_report.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kJoinPoll = milliseconds(20);
constexpr Nanoseconds kAskAgain =
    std::chrono::seconds(1);  // who waits and does not ask is forgotten
constexpr Nanoseconds kJoinReminder = std::chrono::seconds(5);
constexpr Nanoseconds kStatusPeriod = milliseconds(200);
constexpr Nanoseconds kFlushTimeout = milliseconds(300);
constexpr int kGoodByes = 3;  // best effort: one may be lost

// Asks the world for a place, again and again, until it is given or refused for good.
class Asking {
 public:
  Asking(link::VehicleLink* link, VehicleId wanted) : link_(*link) {
    request_.wanted = wanted;
    for (std::uint32_t& word : request_.session) word = app::RandomNonZero();
    Ask();
  }

  const SessionId& Session() const { return request_.session; }
  bool Answered() const { return answered_; }

  void AskAgainIfDue() {
    if (app::SteadyNow() >= again_) Ask();
  }
  // True if this is the last word on the request; a reason to wait is only logged.
  bool IsFinal(const RosterEntry& entry) {
    answered_ = true;
    if (!entry.accepted && entry.waiting)
      app::LogWarning("the world lets it wait: " + entry.reason);
    return entry.accepted || !entry.waiting;
  }

 private:
  void Ask() {
    link_.SendJoin(request_);
    again_ = app::SteadyNow() + kAskAgain;
  }

  link::VehicleLink& link_;
  JoinRequest request_;
  SteadyTime again_{0};
  bool answered_ = false;
};

// Empty if asked to stop meanwhile.
std::optional<RosterEntry> Join(link::VehicleLink* link, const app::StopSignal& stop,
                                VehicleId wanted) {
  Asking asking(link, wanted);
  SteadyTime remind = app::SteadyNow() + kJoinReminder;
  while (!stop.IsSet()) {
    const auto entry = link->TakeRoster(asking.Session());
    if (entry && asking.IsFinal(*entry)) return entry;
    asking.AskAgainIfDue();
    app::SleepUntil(app::SteadyNow() + kJoinPoll);
    if (app::SteadyNow() < remind) continue;
    remind += kJoinReminder;
    if (asking.Answered()) continue;
    app::LogWarning("no answer from a world yet: is giveway-world running in this domain?");
  }
  link->SendLeave(asking.Session());
  return std::nullopt;
}

VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry) {
  const auto& known = entry.spawn == 0 ? scenario.vehicles : scenario.spawns;
  const auto found = entry.spawn == 0 ? std::ranges::find(known, entry.vehicle, &VehicleOptions::id)
                                      : known.begin() + std::min<std::ptrdiff_t>(entry.spawn - 1,
                                                                                 std::ssize(known));
  if (found == known.end()) {
    throw link::LinkError("the world gave this vehicle a place its scenario does not have: id " +
                          std::to_string(Number(entry.vehicle)) +
                          (entry.spawn == 0 ? "" : ", spawn " + std::to_string(entry.spawn)) +
                          "; start both with the same scenario file");
  }
  VehicleOptions options = *found;
  options.id = entry.vehicle;
  options.start_world = entry.start_world;
  return options;
}

// A drill. As of a loop that really hangs: SIGTERM finds it deaf too.
void Hang() {
  app::LogWarning("drill: the control loop hangs");
  while (app::HangSignal::IsUp()) app::SleepUntil(app::SteadyNow() + kJoinPoll);
  app::LogWarning("drill: the control loop goes on");
}

// The loop and what it must remember between two turns.
class Loop {
 public:
  // `recorder` is null where nothing is recorded.
  Loop(link::VehicleLink* link, const Scenario& scenario, const RosterEntry& entry, bool lockstep,
       app::Recorder* recorder)
      : link_(*link),
        scenario_(scenario),
        lockstep_(lockstep),
        recorder_(recorder),
        place_(entry),
        options_(OptionsOf(scenario, entry)),
        boot_epoch_(app::RandomNonZero()),
        vehicle_(options_, boot_epoch_),
        news_(entry) {
    if (recorder_ != nullptr) recorder_->Begin(options_, boot_epoch_);
  }

  // Until the run has ended, `stop` is set, or the world refuses it: false in that case. Says
  // good-bye in the second.
  bool Drive(const app::StopSignal& stop) {
    while (!stop.IsSet() && !RunEnded() && !refused_) Turn(false);
    for (int i = 0; stop.IsSet() && i < kGoodByes; ++i) Turn(true);
    report_.SendFinal(vehicle_, link_);
    link_.FlushStatus(kFlushTimeout);
    if (stop.IsSet() && !RunEnded()) link_.SendLeave(place_.session);
    return !refused_;
  }

 private:
  bool RunEnded() const { return place_.run_state == RunState::kEnded; }

  // A world that was restarted, or that gives the vehicle another place, says where it stands now.
  void Follow(const RosterEntry& entry) {
    if (asking_ && !asking_->IsFinal(entry)) return;
    if (!entry.accepted && entry.waiting) return AskAnew(entry);
    if (!entry.accepted) {
      app::LogError("the world refused this vehicle: " + entry.reason);
      refused_ = true;
      return;
    }
    const bool elsewhere = asking_ || entry.epoch != place_.epoch;
    place_ = entry;
    news_ = entry;
    if (!elsewhere) return;
    asking_.reset();
    options_ = OptionsOf(scenario_, entry);
    vehicle_.Reseat(options_);
    if (recorder_ != nullptr) recorder_->Reseat(options_);
    app::LogInfo("drives on in world " + std::to_string(Number(entry.epoch)));
  }

  // Its place is gone; its id stays if it can, since everything it says is named after it.
  void AskAnew(const RosterEntry& entry) {
    app::LogWarning("lost its place: " + entry.reason);
    asking_.emplace(&link_, options_.id);
  }

  // A scan is awaited half a period longer than it should take; blind, beacons keep their rate.
  Nanoseconds Patience() const {
    const bool blind = app::SteadyNow() - last_scan_ > options_.ranges_age_limit;
    const Nanoseconds due = last_beacon_ + options_.tick_period * (blind ? 2 : 3) / 2;
    return std::max(Nanoseconds{0}, due - app::SteadyNow());
  }

  void Turn(bool leaving) {
    const bool woken = link_.WaitForScan(leaving ? Nanoseconds{0} : Patience());
    if (app::HangSignal::IsUp()) Hang();
    const SteadyTime woke = app::SteadyNow();
    link::Taken taken = link_.Take(woke);
    Inputs& inputs = taken.inputs;
    if (inputs.roster) Follow(*inputs.roster);
    if (asking_) asking_->AskAgainIfDue();
    inputs.leaving = leaving;
    if (inputs.scan) last_scan_ = woke;
    const std::span<const QosEvent> events = inputs.events;
    if (lockstep_ && !leaving && !KeepWorldTime(&inputs)) return Tell(events);

    inputs.roster = std::exchange(news_, std::nullopt);
    const SteadyTime before = app::SteadyNow();
    Outputs outputs = vehicle_.Step(inputs);
    const SteadyTime after = app::SteadyNow();
    outputs.command.matched_peers = link_.Counters().matched_peers;
    link_.Send(outputs);
    last_beacon_ = woke;
    report_.NoteStep(after - before, woken ? app::SteadyNow() - woke : Nanoseconds{0});
    // After the wheels have their command: nobody waits for what follows.
    if (recorder_ != nullptr) recorder_->Step(inputs, outputs, vehicle_.Hash());
    if (outputs.decision_changed) app::LogInfo(Describe(outputs.command.decision));
    Tell(events);
    TellOfBeacons(inputs.now, woke);
    if (outputs.decision_changed || woke >= next_status_) {
      report_.Send(vehicle_, link_);
      next_status_ = woke + kStatusPeriod;
    }
  }

  // What the middleware says of the peers. Whoever comes or goes is news, the rest is trouble.
  void Tell(std::span<const QosEvent> events) {
    report_.NoteEvents(events);
    for (const QosEvent& event : events) {
      const bool is_trouble = event.kind == QosEventKind::kDeadlineMissed ||
                              event.kind == QosEventKind::kLivelinessLost ||
                              event.kind == QosEventKind::kIncompatibleQos;
      is_trouble ? app::LogWarning(Describe(event), event.at)
                 : app::LogInfo(Describe(event), event.at);
    }
  }

  // Whose beacons can be decided by, and whose no more. `now` is what the brain takes for the time.
  void TellOfBeacons(SteadyTime now, SteadyTime woke) {
    beacon_news_.Look(vehicle_.State().peers.Peers(), now, vehicle_.State().tick, options_);
    for (const BeaconNewsItem& item : beacon_news_.Items()) {
      const bool is_trouble = item.kind == BeaconNewsKind::kStale;
      is_trouble ? app::LogWarning(Describe(item), woke) : app::LogInfo(Describe(item), woke);
    }
    const auto blackouts_since = told_blackouts_ ? std::nullopt : link_.BlackoutsSince();
    if (!blackouts_since) return;
    told_blackouts_ = true;
    app::LogInfo("impairment: blackouts are counted from here", *blackouts_since);
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
  const Scenario& scenario_;
  const bool lockstep_;
  app::Recorder* const recorder_;
  RosterEntry place_;
  VehicleOptions options_;
  const std::uint32_t boot_epoch_;
  Vehicle vehicle_;
  std::optional<RosterEntry> news_;  // that the brain has yet to hear
  std::optional<Asking> asking_;     // for another place
  bool refused_ = false;
  VehicleReport report_;
  BeaconNews beacon_news_;
  bool told_blackouts_ = false;
  SteadyTime last_scan_{0};
  SteadyTime last_beacon_{0};
  SteadyTime next_status_{0};
  std::vector<ReceivedBeacon> held_;
  std::vector<ReceivedBeacon> in_lockstep_;
};

// Only vehicles hear through it: the world's ears are the wires to the wheels.
Impairment ImpairmentOf(const app::ServiceFlags& flags, const Scenario& scenario) {
  Impairment impairment = flags.impair.value_or(scenario.impairment);
  if (!impairment.seed) impairment.seed = scenario.seed;
  return impairment;
}

int Run(const app::ServiceFlags& flags, const app::StopSignal& stop) {
  const std::string name = flags.id == 0 ? "vehicle" : "vehicle " + std::to_string(flags.id);
  app::InitLog(name, flags.log_format, flags.log_level);
  const Scenario scenario = app::LoadScenario(
      flags.scenario,
      {.seed = flags.seed, .behaviour = flags.behaviour, .duration_s = flags.duration_s});
  std::optional<app::Recorder> recorder;
  if (!flags.record.empty()) recorder.emplace(flags.record);
  link::LinkOptions link_options = LinkOptionsOf(flags, scenario);
  link_options.impairment = ImpairmentOf(flags, scenario);
  link::VehicleLink link(link_options);
  const auto entry = Join(&link, stop, VehicleId{flags.id});
  if (!entry) return 0;
  if (!entry->accepted) {
    app::LogError("the world refused this vehicle: " + entry->reason);
    return 2;
  }
  if (flags.id == 0) app::LogInfo("is vehicle " + std::to_string(Number(entry->vehicle)));
  const VehicleOptions options = OptionsOf(scenario, *entry);
  link.Open(options.id, options.profile, !scenario.signals.empty());
  std::optional<app::HangSignal> hang;
  if (flags.hang_on_signal) hang.emplace();
  Loop loop(&link, scenario, *entry, flags.lockstep, recorder ? &*recorder : nullptr);
  const bool welcome = loop.Drive(stop);
  if (const auto impaired = link.Impaired()) app::LogInfo(Describe(*impaired));
  return welcome ? 0 : 2;
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  return giveway::ServiceMain(giveway::app::ParseVehicleFlags(argc, argv), giveway::Run);
}

// giveway-vehicle: one vehicle, one process, one participant.
//
//   VehicleLink::Take -> Inputs -> Vehicle::Step -> Outputs -> VehicleLink::Send
//
// The loop wakes on its own ranges, or when the next beacon is due without them. This file only
// wires; deciding is services/vehicle, talking is services/link.
#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "services/config/scenario_file.h"
#include "services/config/text_file.h"
#include "services/link/fastdds/library_release.h"
#include "services/link/vehicle_link.h"
#include "services/node/server_wait.h"
#include "services/node/service_admin.h"
#include "services/node/service_main.h"
#include "services/node/service_run.h"
#include "services/recording/recorder.h"
#include "services/runtime/hang_signal.h"
#include "services/runtime/identity.h"
#include "services/runtime/process.h"
#include "services/runtime/refusal_log.h"
#include "services/runtime/restart.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/refused_beacon.h"
#include "services/vehicle/vehicle.h"
#include "services/vehicle_node/beacon_news.h"
#include "services/vehicle_node/vehicle_health.h"
#include "services/vehicle_node/vehicle_hearing.h"
#include "services/vehicle_node/vehicle_join.h"
#include "services/vehicle_node/vehicle_report.h"
#include "services/vehicle_node/world_time.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kStatusPeriod = milliseconds(200);
constexpr Nanoseconds kFlushTimeout = milliseconds(300);
// From an order to restart to standing; the world brakes whom it does not hear.
constexpr Nanoseconds kHaltPatience = std::chrono::seconds(5);
constexpr int kGoodByes = 3;  // best effort: one may be lost

enum class DriveEnd { kOver, kRefused, kRestarts, kDeaf };

// The loop and what it must remember between two turns.
class Loop {
 public:
  // `recorder` is null where nothing is recorded; `on_first_scan` is called once.
  Loop(link::VehicleLink* link, ServiceAdmin* admin, VehicleHealthTeller* health,
       const Scenario& scenario, const RosterEntry& entry, const ServiceFlags& flags,
       Recorder* recorder, std::function<void()> on_first_scan)
      : link_(*link),
        admin_(*admin),
        health_(*health),
        scenario_(scenario),
        lockstep_(flags.lockstep),
        stays_(flags.stay),
        recorder_(recorder),
        on_first_scan_(std::move(on_first_scan)),
        place_(entry),
        options_(OptionsOf(scenario, entry)),
        boot_epoch_(RandomNonZero()),
        vehicle_(options_, boot_epoch_),
        news_(entry) {
    std::optional<Handover> handover = flags.resume ? flags.resume->handover : std::nullopt;
    if (handover && !TakeOver(*handover)) handover.reset();
    if (recorder_ != nullptr) recorder_->Begin(options_, boot_epoch_, handover);
    health_.Placed(options_.id, options_.ranges_age_limit);
  }

  // Until the run has ended (unless it stays), `stop` is set, the world refuses it, or an
  // operator's order takes a restart. Halts and says good-bye if the run goes on without it; for
  // good only in the second case, in the last it keeps its place.
  DriveEnd Drive(const StopSignal& stop) {
    while (!stop.IsSet() && !IsOver() && !restarts_ && remedy_ == Remedy::kNone) Turn(false);
    if (remedy_ == Remedy::kNewProcess) return DriveEnd::kDeaf;
    restarts_ = restarts_ || remedy_ == Remedy::kNewParticipant;
    if (restarts_) Halt(stop);
    const bool restarts = restarts_ && !IsOver();
    health_.Leaves();
    const bool goes = stop.IsSet() || restarts;
    for (int i = 0; goes && i < kGoodByes; ++i) Turn(true);
    if (restarts && !stop.IsSet()) AskForTime();
    // It may have been told to stop while it asked; then it leaves.
    if (restarts && !stop.IsSet()) return DriveEnd::kRestarts;
    report_.SendFinal(vehicle_, link_);
    // Said before the wait: whoever has died without a word delays both, and may do so only once.
    if (stop.IsSet() && !RunEnded()) link_.SendLeave(place_.session);
    link_.FlushStatus(kFlushTimeout);
    return refused_ ? DriveEnd::kRefused : DriveEnd::kOver;
  }
  const SessionId& Session() const { return place_.session; }
  VehicleId Id() const { return options_.id; }
  std::optional<Handover> HandOver() const { return vehicle_.HandOver(); }

 private:
  // False where it is not to be gone by: then the world's word is.
  bool TakeOver(const Handover& handover) {
    if (!IsOfTheSameBody(handover, place_)) {
      LogWarning("stands elsewhere than before its restart: begins where the world says");
      return false;
    }
    return vehicle_.TakeOver(handover);
  }

  // While it rolls it is not gone from: its peers hear from it until it stands.
  void Halt(const StopSignal& stop) {
    const SteadyTime give_up = SteadyNow() + kHaltPatience;
    while (!vehicle_.Stands() && !stop.IsSet() && !IsOver() && SteadyNow() < give_up) {
      Turn(false);
    }
  }

  // To the world a second of silence is a death. Who asks for its place again is given longer,
  // until it speaks; so what it said last must have been taken by then.
  void AskForTime() {
    SleepUntil(SteadyNow() + 3 * options_.tick_period);
    link_.SendJoin({place_.session, options_.id});
    link_.FlushJoin(kFlushTimeout);
    link_.FlushAnswer(kFlushTimeout);  // an operator must know that the silence is meant
  }

  bool RunEnded() const { return place_.run_state == RunState::kEnded; }
  bool IsOver() const { return refused_ || (RunEnded() && !stays_); }

  // A world that was restarted, or that gives the vehicle another place, says where it stands now.
  void Follow(const RosterEntry& entry) {
    if (asking_ && RunEnded() && entry.epoch == place_.epoch) return;  // of the run that is over
    if (asking_ && !asking_->IsFinal(entry)) return;
    if (!entry.accepted && entry.waiting) return AskAnew(entry);
    if (!entry.accepted) {
      LogError("the world refused this vehicle: " + entry.reason);
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
    health_.Placed(options_.id, options_.ranges_age_limit);
    LogInfo("drives on in world " + std::to_string(Number(entry.epoch)));
  }

  // The run is over. Who stays asks the next world, as the same session: that world may know it
  // from the request that is kept for later worlds already.
  void AwaitNextWorld() {
    if (!stays_ || !RunEnded() || asking_) return;
    LogInfo("the run has ended: waits for the next world");
    asking_.emplace(&link_, options_.id, place_.session);
  }

  // Its place is gone; its id stays if it can, since everything it says is named after it.
  void AskAnew(const RosterEntry& entry) {
    LogWarning("lost its place: " + entry.reason);
    asking_.emplace(&link_, options_.id);
  }

  // A scan is awaited half a period longer than it should take; blind, beacons keep their rate.
  Nanoseconds Patience() const {
    const bool blind = SteadyNow() - last_scan_ > options_.ranges_age_limit;
    const Nanoseconds due = last_beacon_ + options_.tick_period * (blind ? 2 : 3) / 2;
    return std::max(Nanoseconds{0}, due - SteadyNow());
  }

  void Turn(bool leaving) {
    const bool woken = link_.WaitForScan(leaving ? Nanoseconds{0} : Patience());
    if (HangSignal::IsUp()) HangWhileUp();
    const SteadyTime woke = SteadyNow();
    link::Taken taken = link_.Take(woke);
    Inputs& inputs = taken.inputs;
    if (inputs.roster) Follow(*inputs.roster);
    AwaitNextWorld();
    health_.Turned(taken, link_.Counters(), place_, woke);
    if (asking_) {
      asking_->AskAgainIfDue();
      health_.Joins(asking_->WaitsFor());
    }
    inputs.leaving = leaving;
    inputs.halting = restarts_;
    if (inputs.scan) last_scan_ = woke;
    const std::span<const QosEvent> events = inputs.events;
    LogNews(taken.refusals, link_.TakeUnfit(woke), woke, &refusal_log_);
    if (lockstep_ && !leaving && !world_time_.Keep(&inputs, options_.tick_period)) {
      return Tell(events);
    }

    inputs.roster = std::exchange(news_, std::nullopt);
    const SteadyTime before = SteadyNow();
    Outputs outputs = vehicle_.Step(inputs);
    const SteadyTime after = SteadyNow();
    outputs.command.matched_peers = link_.Counters().matched_peers;
    link_.Send(outputs);
    last_beacon_ = woke;
    report_.NoteStep(after - before, woken ? SteadyNow() - woke : Nanoseconds{0});
    // After the wheels have their command: nobody waits for what follows.
    if (recorder_ != nullptr) recorder_->Step(inputs, outputs, vehicle_.Hash());
    if (outputs.decision_changed) LogInfo(Describe(outputs.command.decision));
    Tell(events);
    TellOfRefusals(inputs.beacons, woke);
    if (!leaving && !restarts_ && admin_.Serve()) restarts_ = true;
    const bool looks = !leaving && !restarts_ && !lockstep_;
    if (looks) remedy_ = hearing_.Look(woke, inputs.scan.has_value());
    TellOfBeacons(inputs.now, woke);
    if (inputs.scan && on_first_scan_) std::exchange(on_first_scan_, nullptr)();
    if (outputs.decision_changed || woke >= next_status_) {
      health_.Reported(report_.Send(vehicle_, link_));
      next_status_ = woke + kStatusPeriod;
    }
  }

  // What the middleware says of the peers. Whoever comes or goes is news, the rest is trouble; that
  // a beacon was lost is neither on a radio, and would be said many times a second.
  void Tell(std::span<const QosEvent> events) {
    report_.NoteEvents(events);
    for (const QosEvent& event : events) {
      switch (event.kind) {
        case QosEventKind::kDeadlineMissed:
        case QosEventKind::kLivelinessLost:
          if (HasLeft(event.vehicle)) break;  // its writer is gone a moment after its good-bye
          [[fallthrough]];
        case QosEventKind::kIncompatibleQos:
          LogWarning(Describe(event), event.at);
          break;
        case QosEventKind::kSampleLost:
          LogDebug(Describe(event));
          break;
        default:
          LogInfo(Describe(event), event.at);
      }
    }
  }

  // What the brain refused. What is broken or misnamed the link has said, and knows more of it.
  void TellOfRefusals(std::span<const ReceivedBeacon> beacons, SteadyTime now) {
    std::vector<Refusal> refusals;
    for (const RefusedBeacon& refused : vehicle_.Refused()) {
      if (refused.why == BeaconRefusal::kCrc || refused.why == BeaconRefusal::kWrongName) continue;
      refusals.push_back(Explain(beacons[refused.index], refused.why, vehicle_.State()));
    }
    LogNews(refusals, {}, now, &refusal_log_);
  }

  bool HasLeft(VehicleId peer) const {
    const auto peers = vehicle_.State().peers.Peers();
    const auto found = std::ranges::find(peers, peer, &Peer::id);
    return found != peers.end() && found->left;
  }

  // Whose beacons can be decided by, and whose no more. `now` is what the brain takes for the time.
  void TellOfBeacons(SteadyTime now, SteadyTime woke) {
    beacon_news_.Look(vehicle_.State().peers.Peers(), now, vehicle_.State().tick, options_);
    for (const BeaconNewsItem& item : beacon_news_.Items()) {
      const bool is_trouble = item.kind == BeaconNewsKind::kStale;
      is_trouble ? LogWarning(Describe(item), woke) : LogInfo(Describe(item), woke);
    }
    const auto blackouts_since = told_blackouts_ ? std::nullopt : link_.BlackoutsSince();
    if (!blackouts_since) return;
    told_blackouts_ = true;
    LogInfo("impairment: blackouts are counted from here", *blackouts_since);
  }

  link::VehicleLink& link_;
  ServiceAdmin& admin_;
  VehicleHealthTeller& health_;
  const Scenario& scenario_;
  const bool lockstep_;
  const bool stays_;
  Recorder* const recorder_;
  std::function<void()> on_first_scan_;
  RosterEntry place_;
  VehicleOptions options_;
  const std::uint32_t boot_epoch_;
  Vehicle vehicle_;
  std::optional<RosterEntry> news_;  // that the brain has yet to hear
  std::optional<Asking> asking_;     // for another place
  bool refused_ = false;
  bool restarts_ = false;
  Hearing hearing_{&link_};
  Remedy remedy_ = Remedy::kNone;
  VehicleReport report_;
  BeaconNews beacon_news_;
  RefusalLog refusal_log_;
  bool told_blackouts_ = false;
  SteadyTime last_scan_{0};
  SteadyTime last_beacon_{0};
  SteadyTime next_status_{0};
  WorldTime world_time_;
};

// What it takes to come back as the same vehicle with the profiles of an order.
NewFlags ToComeBack(const Loop& loop, const ServiceAdmin& admin) {
  NewFlags flags = admin.ToComeBack();
  flags["--id"] = std::to_string(Number(loop.Id()));
  flags["--resume"] = HoldText("resume", ToBytes({loop.Session(), admin.Order(), loop.HandOver()}));
  return flags;
}

// From joining to the end of the link; see service_run.h.
std::optional<NewFlags> LiveAsVehicle(const ServiceFlags& flags, const Scenario& scenario,
                                      const StopSignal& stop, const std::function<void()>& settled,
                                      int* exit_code) {
  VehicleHealthTeller health(flags);
  std::optional<Recorder> recorder;
  if (!flags.record.empty()) recorder.emplace(flags.record, flags.record_split);
  link::LinkOptions link_options = LinkOptionsOf(flags, scenario);
  link_options.impairment = ImpairmentOf(flags, scenario);
  if (!AwaitServers(link_options, stop, [&](const std::string& why) { health.Joins(why); })) {
    return {};
  }
  link::VehicleLink link(link_options);
  PublishIdentity({kNobody, link.ParticipantText()});
  const QosProfiles profiles{NameOf(flags.qos), ReadBytes(flags.qos)};
  LetGo(flags.qos);
  const std::optional<SessionId> session =
      flags.resume ? std::optional(flags.resume->session) : std::nullopt;
  const auto entry = Join(&link, stop, VehicleId{flags.id}, session, &health);
  if (!entry) return {};
  if (!entry->accepted) {
    LogError("the world refused this vehicle: " + entry->reason);
    *exit_code = 2;
    return {};
  }
  PublishIdentity({entry->vehicle, link.ParticipantText()});
  SetLogVehicle(entry->vehicle);
  if (flags.id == 0) LogInfo("is vehicle " + std::to_string(Number(entry->vehicle)));
  const VehicleOptions options = OptionsOf(scenario, *entry);
  link.Open(options.id, options.profile, !scenario.signals.empty());
  ServiceAdmin admin(&link, link_options, options.id, profiles, flags.lockstep);
  // With shared memory the library touches some of it only when samples go.
  const auto on_first_scan = [&] {
    settled();
    if (!flags.resume || flags.resume->order == 0) return;
    admin.AnswerResumed(flags.resume->order, flags.rolled_back);
  };
  std::optional<HangSignal> hang;
  if (flags.hang_on_signal) hang.emplace();
  Loop loop(&link, &admin, &health, scenario, *entry, flags, recorder ? &*recorder : nullptr,
            on_first_scan);
  const DriveEnd end = loop.Drive(stop);
  LogInfo(Describe(link.Counters()));
  if (const auto impaired = link.Impaired()) LogInfo(Describe(*impaired));
  if (end == DriveEnd::kRefused) *exit_code = 2;
  if (end == DriveEnd::kDeaf) *exit_code = 1;
  if (end != DriveEnd::kRestarts) return {};
  return ToComeBack(loop, admin);
}

int Run(const ServiceFlags& flags, const StopSignal& stop) {
  const std::string name = flags.id == 0 ? "vehicle" : "vehicle " + std::to_string(flags.id);
  InitLog(name, flags.log_format, flags.log_level);
  SetLogVehicle(VehicleId{flags.id});
  const Scenario scenario = LoadScenario(
      flags.scenario,
      {.seed = flags.seed, .behaviour = flags.behaviour, .duration_s = flags.duration_s});
  return RunService(flags, scenario, stop,
                    [&](const std::function<void()>& settled, int* exit_code) {
                      return LiveAsVehicle(flags, scenario, stop, settled, exit_code);
                    });
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  return giveway::ServiceMain(giveway::ParseVehicleFlags(argc, argv, giveway::link::LibraryName()),
                              giveway::Run);
}

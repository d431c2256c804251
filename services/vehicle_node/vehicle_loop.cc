#include "services/vehicle_node/vehicle_loop.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "services/link/fastdds/packets_of_process.h"
#include "services/runtime/hang_signal.h"
#include "services/runtime/process.h"
#include "services/snapshot/brain_state.h"
#include "services/vehicle_node/vehicle_join.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kStatusPeriod = milliseconds(200);
constexpr Nanoseconds kFlushTimeout = milliseconds(300);
// From an order to restart to standing; the world brakes a vehicle that it does not hear.
constexpr Nanoseconds kHaltPatience = std::chrono::seconds(5);
constexpr int kGoodByes = 3;  // best effort: one may be lost

bool HaveTheSameSensors(const RobotModel& one, const RobotModel& other) {
  return one.radar == other.radar && one.lidar == other.lidar && one.camera == other.camera &&
         one.pose_fix.Fitted() == other.pose_fix.Fitted();
}

}  // namespace

VehicleLoop::VehicleLoop(const VehicleLoopParts& parts, const Scenario& scenario,
                         const RosterEntry& entry, const VehicleLoopOptions& options)
    : link_(*parts.link),
      clock_(*parts.clock),
      health_(*parts.health),
      recorder_(parts.recorder),
      serve_orders_(parts.serve_orders),
      on_first_scan_(parts.on_first_scan),
      scenario_(scenario),
      lockstep_(options.lockstep),
      place_(&link_, &clock_, entry, options.stays),
      options_(OptionsOf(scenario, entry)),
      opened_for_(options_.profile),
      boot_epoch_(RandomNonZero()),
      vehicle_(options_, boot_epoch_),
      news_(entry),
      reception_(&link_, clock_.Now()),
      report_(options_) {
  std::optional<Handover> handover = options.handover;
  if (handover && !TakeOver(*handover)) handover.reset();
  if (recorder_ != nullptr) recorder_->Begin(options_, boot_epoch_, handover);
  health_.OnPlaced(options_.id, options_.ranges_age_limit);
}

// False where it is not to be gone by: then the world's word is.
bool VehicleLoop::TakeOver(const Handover& handover) {
  if (!IsOfTheSameBody(handover, place_.Entry())) {
    LogWarning("stands elsewhere than before its restart: starts where the world says");
    return false;
  }
  return vehicle_.TakeOver(handover);
}

DriveEnd VehicleLoop::Drive(const std::function<bool()>& is_stopped) {
  while (!is_stopped() && !place_.IsOver() && !restarts_ && remedy_ == Remedy::kNone) Turn(false);
  if (remedy_ == Remedy::kNewProcess) return DriveEnd::kScansLost;
  restarts_ = restarts_ || remedy_ == Remedy::kNewParticipant;
  if (restarts_) Halt(is_stopped);
  const bool restarts = restarts_ && !place_.IsOver();
  health_.OnLeaving();
  const bool goes = is_stopped() || restarts;
  for (int i = 0; goes && i < kGoodByes; ++i) Turn(true);
  if (restarts && !is_stopped()) AskForTime();
  // It may have been stopped while it asked; then it leaves.
  if (restarts && !is_stopped()) return DriveEnd::kRestarts;
  report_.SendFinal(vehicle_, link_);
  // Sent before the wait: a process that died silently delays both, and may do so only once.
  if (is_stopped() && !place_.RunHasEnded()) link_.SendLeave(Session());
  link_.FlushStatus(kFlushTimeout);
  return place_.IsRefused() ? DriveEnd::kRefused : DriveEnd::kOver;
}

// While it rolls it is not gone from: its peers hear from it until it stands.
void VehicleLoop::Halt(const std::function<bool()>& is_stopped) {
  const SteadyTime give_up = clock_.Now() + kHaltPatience;
  while (!vehicle_.Stands() && !is_stopped() && !place_.IsOver() && clock_.Now() < give_up) {
    Turn(false);
  }
}

// To the world a second of silence is a death. A vehicle that asks for its place again is given
// longer, until it sends a command; so its last one must have been taken by then.
void VehicleLoop::AskForTime() {
  clock_.SleepUntil(clock_.Now() + 3 * options_.tick_period);
  link_.SendJoin({Session(), options_.id});
  link_.FlushJoin(kFlushTimeout);
  link_.FlushAnswer(kFlushTimeout);  // an operator must know that the silence is meant
}

// A scan is awaited half a period longer than it should take; blind, beacons keep their rate. In
// lockstep a turn without a scan sends none, and the next waits as long all the same.
Nanoseconds VehicleLoop::Patience() const {
  const bool blind = clock_.Now() - last_scan_ > options_.ranges_age_limit;
  const Nanoseconds due = last_turn_ + options_.tick_period * (blind ? 2 : 3) / 2;
  return std::max(Nanoseconds{0}, due - clock_.Now());
}

void VehicleLoop::Turn(bool leaving) {
  const bool by_scan = link_.WaitForScan(leaving ? Nanoseconds{0} : Patience());
  if (HangSignal::IsUp()) HangWhileUp();
  const SteadyTime woke = last_turn_ = clock_.Now();
  link::Taken taken = link_.Take(woke);
  Inputs& inputs = taken.inputs;
  KeepPlace(taken, woke);
  inputs.leaving = leaving;
  inputs.halting = restarts_;
  if (inputs.scan) last_scan_ = woke;
  const std::span<const QosEvent> events = inputs.events;
  log_.LogLink(taken.refusals, link_.TakeUnfit(woke), woke);
  log_.LogPackets(link::PacketsOfProcess(), woke);
  report_.NoteLeft(taken.left);
  if (lockstep_ && !leaving && !world_time_.Keep(&inputs, options_.tick_period)) {
    return LogEvents(events, woke);
  }
  const bool decision_changed = Step(&taken, woke, by_scan);
  LogEvents(events, woke);
  log_.LogRefusals(inputs.beacons, vehicle_, woke);
  if (!leaving && !restarts_ && serve_orders_()) restarts_ = true;
  const bool looks = !leaving && !restarts_ && !lockstep_;
  // Until its first scan it may have to come back with the profiles it had before.
  if (looks) remedy_ = reception_.Update(woke, inputs.scan.has_value(), !on_first_scan_);
  log_.LogFreshness(vehicle_, options_, inputs.now, woke);
  log_.LogBlackouts(link_.BlackoutsSince());
  if (inputs.scan && on_first_scan_) std::exchange(on_first_scan_, nullptr)();
  if (!decision_changed && woke < next_status_) return;
  health_.OnStatus(report_.Send(vehicle_, link_, woke), vehicle_.State());
  next_status_ = woke + kStatusPeriod;
}

void VehicleLoop::KeepPlace(const link::Taken& taken, SteadyTime woke) {
  if (taken.inputs.roster) Follow(*taken.inputs.roster);
  place_.KeepAsking(!lockstep_ && link_.LacksBody());
  health_.OnTick(taken, link_.Counters(), place_.Entry(), woke);
  if (const std::string* reason = place_.WaitsFor()) health_.OnJoining(*reason);
}

// A world that was restarted, or that gives the vehicle another place, says where it stands now.
void VehicleLoop::Follow(const RosterEntry& entry) {
  const std::string why = WhyNoPlace(scenario_, entry, Id());
  if (!why.empty()) {
    place_.FollowRun(entry);  // wherever it is: it would not end with its run
    const Refusal refusal = RefusalOf(entry, why);
    log_.LogLink({&refusal, 1}, {}, clock_.Now());
    return;
  }
  const PlaceNews news = place_.Follow(entry);
  if (news == PlaceNews::kNone) return;
  news_ = entry;
  if (news != PlaceNews::kElsewhere) return;
  options_ = OptionsOf(scenario_, entry);
  vehicle_.Reseat(options_);
  report_.Reseat(options_);
  if (recorder_ != nullptr) recorder_->Reseat(options_);
  health_.OnPlaced(options_.id, options_.ranges_age_limit);
  LogInfo("drives on in world " + std::to_string(Number(entry.epoch)));
  if (HaveTheSameSensors(opened_for_, options_.profile)) return;
  LogInfo("its place there has other sensors: restarts itself");
  restarts_ = true;
}

// True if the decision is another one.
bool VehicleLoop::Step(link::Taken* taken, SteadyTime woke, bool by_scan) {
  Inputs* const inputs = &taken->inputs;
  inputs->roster = std::exchange(news_, std::nullopt);
  const Nanoseconds before = clock_.ThreadTime();
  Outputs outputs = vehicle_.Step(*inputs);
  const Nanoseconds decided = clock_.ThreadTime() - before;
  outputs.command.matched_peers = link_.Counters().matched_peers;
  link_.Send(outputs);
  const SteadyTime sent = clock_.Now();
  report_.NoteStep(decided, by_scan ? sent - woke : Nanoseconds{0});
  // After the wheels have their command: the rest is not time-critical.
  const auto spent = report_.NoteTurn({.woke = woke,
                                       .sent = sent,
                                       .scan = inputs->scan ? &*inputs->scan : nullptr,
                                       .scan_latency = taken->scan_latency,
                                       .beacon_latency = taken->beacon_latency,
                                       .command = outputs.command,
                                       .evidence = vehicle_.Evidence()});
  report_.NoteBeacons(inputs->beacons, vehicle_.Fates());
  if (spent) LogWarning("budget_spent: " + Describe(*spent));
  if (recorder_ != nullptr) {
    recorder_->Step(*inputs, outputs, vehicle_.Hash());
    if (recorder_->WantsImage(sent)) {
      recorder_->Image(BytesOf(vehicle_.State()), vehicle_.Hash(), sent);
    }
  }
  if (outputs.decision_changed) LogInfo(Describe(outputs.command.decision));
  return outputs.decision_changed;
}

void VehicleLoop::LogEvents(std::span<const QosEvent> events, SteadyTime woke) {
  report_.NoteEvents(events);
  log_.LogEvents(events, vehicle_, woke);
}

}  // namespace giveway

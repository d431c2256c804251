#include "sim_world/run/run.h"

#include <algorithm>
#include <utility>

#include "services/types/check.h"
#include "services/types/time.h"

namespace giveway::sim {
namespace {

constexpr Nanoseconds kReportedGone{1'000'000'000};  // observers hear best effort, once a tick
constexpr double kBeforeStart_s = -1;  // Truth::time_s while the start is still to come

std::optional<std::uint32_t> DurationTicks(const Scenario& scenario) {
  if (IsEndless(scenario)) return std::nullopt;
  return TicksCovering(FromSeconds(scenario.duration_s), scenario.tick_period);
}

}  // namespace

Run::Run(const Scenario& scenario, WorldEpoch epoch, ParallelFor parallel,
         const FaultSchedule& schedule)
    : scenario_(scenario),
      open_(!scenario.spawns.empty()),
      epoch_(epoch),
      world_(scenario, epoch, std::move(parallel)),
      pose_sensing_(scenario),
      signals_(scenario),
      faults_(scenario),
      world_faults_(schedule, scenario.tick_period),
      silence_(schedule.faults),
      evaluator_(scenario),
      liveness_(scenario),
      log_(epoch),
      duration_ticks_(DurationTicks(scenario)) {
  scans_.reserve(scenario.vehicles.size());
  truths_.reserve(scenario.vehicles.size());
}

void Run::Join(VehicleId vehicle) {
  world_.Join(vehicle);
  liveness_.Join(vehicle, world_.Now());
}

void Run::Join(const VehicleOptions& options) {
  if (BodyOf(options.id) == nullptr) {
    world_.Join(options);
    evaluator_.Restart(options.id);
  }
  liveness_.Join(options.id, world_.Now());
  faults_.Return(options.id);
  if (state_ == RunState::kRunning) Announce(EventKind::kJoined, options.id);
}

void Run::Leave(VehicleId vehicle) {
  liveness_.Leave(vehicle);
  if (BodyOf(vehicle) == nullptr) return;
  Announce(EventKind::kLeft, vehicle);
  TakeAway(vehicle);
  if (!open_ && started_) End("vehicle_left");  // also while a resumed run waits
}

void Run::Announce(EventKind kind, VehicleId vehicle) {
  comings_and_goings_.push_back(
      {.kind = kind,
       .vehicle = vehicle,
       .position_world = BodyOf(vehicle)->world_from_body.position_world});
}

const Body* Run::BodyOf(VehicleId vehicle) const {
  const auto body = std::ranges::lower_bound(world_.Bodies(), vehicle, {}, &Body::vehicle);
  const bool there = body != world_.Bodies().end() && body->vehicle == vehicle && body->present;
  return there ? &*body : nullptr;
}

void Run::Locate(const VehicleOptions& options, RosterEntry* entry) const {
  const Body* body = BodyOf(options.id);
  if (body == nullptr) return;
  entry->start_world = body->world_from_body;
  entry->tick = Now();
  entry->counted = body->counted;
  entry->task = OnRoute(options.route, body->command.task);
}

bool Run::EveryoneJoined() const {
  return std::ranges::all_of(world_.Bodies(), [](const Body& body) { return body.joined; });
}

void Run::Start() {
  GIVEWAY_CHECK(state_ == RunState::kWaiting);
  state_ = RunState::kRunning;
  started_ = true;
  liveness_.Start(world_.Now());
}

void Run::End(std::string reason) {
  GIVEWAY_CHECK(!reason.empty());
  if (state_ != RunState::kEnded) asked_end_ = std::move(reason);
}

double Run::TimeSeconds() const { return ticks_run_ * Seconds(scenario_.tick_period); }

void Run::TakeAway(VehicleId vehicle) {
  world_.Remove(vehicle);
  std::erase_if(gone_, [&](const Gone& gone) { return gone.vehicle == vehicle; });
  const bool named =
      std::ranges::binary_search(scenario_.vehicles, vehicle, {}, &VehicleOptions::id);
  if (!named) gone_.push_back({vehicle, world_.Now()});
}

void Run::ForgetGone() {
  forgotten_.clear();
  const std::uint32_t reported_ticks = TicksCovering(kReportedGone, scenario_.tick_period);
  std::erase_if(gone_, [&](const Gone& gone) {
    if (BodyOf(gone.vehicle) != nullptr) return true;
    if (TicksBetween(gone.since, world_.Now()) < reported_ticks) return false;
    world_.Forget(gone.vehicle);
    liveness_.Leave(gone.vehicle);
    evaluator_.Forget(gone.vehicle);
    forgotten_.push_back(gone.vehicle);
    return true;
  });
}

void Run::Advance(std::span<const MotorCommand> commands) {
  ForgetGone();
  Take(commands);
  const bool running = state_ == RunState::kRunning;
  if (running) {
    world_faults_.BeginTick(ticks_run_ + 1, world_.Bodies());
  } else {
    world_faults_.Rest();
  }
  world_.SetDriveFaults(world_faults_.OfDrives());
  world_.Advance(running);
  if (running) ++ticks_run_;
  log_.BeginTick(world_.Now(), TimeSeconds());
  for (WorldEvent& event : comings_and_goings_) log_.Add(std::move(event));
  comings_and_goings_.clear();
  if (running) {
    Observe();
  } else if (state_ != RunState::kEnded) {
    LogContacts(world_.NewContacts(), &log_);  // of bodies that still brake: they count, too
  }
  if (state_ != RunState::kEnded) CheckEnd();
  Publish(running);
}

void Run::Observe() {
  if (ticks_run_ == 1) {
    const auto fleet = std::ranges::count_if(world_.Bodies(), &Body::joined);
    log_.Add({.kind = EventKind::kStarted, .value = static_cast<double>(fleet)});
  }
  LogSchedule();
  evaluator_.Observe(TimeSeconds(), world_.Bodies(), world_.NewContacts(), &log_);
  FollowFaults();
  FollowLiveness();
}

void Run::LogSchedule() {
  const auto log = [&](EventKind kind, const faults::Fault& fault) {
    log_.Add({.kind = kind, .vehicle = fault.target.vehicle, .text = EventText(fault)});
  };
  for (const faults::Fault* fault : world_faults_.Ended()) log(EventKind::kFaultOver, *fault);
  for (const faults::Fault* fault : world_faults_.Begun()) log(EventKind::kFaultBegan, *fault);
}

void Run::Take(std::span<const MotorCommand> commands) {
  for (const MotorCommand& command : commands) {
    const bool silent = liveness_.IsSilent(command.vehicle);
    if (silent && !MayReturn(command.vehicle)) continue;
    if (!world_.Take(command)) continue;
    if (silent) {
      liveness_.Join(command.vehicle, world_.Now());
      Announce(EventKind::kJoined, command.vehicle);
    }
    liveness_.Heard(command.vehicle, After(world_.Now(), 1));
  }
}

void Run::AsksAgain(VehicleId vehicle) {
  if (!liveness_.IsSilent(vehicle)) liveness_.Join(vehicle, world_.Now());
}

// In a closed run silence is permanent unless it is planned. In an open one the network may have
// been away for a while.
bool Run::MayReturn(VehicleId vehicle) const {
  return (open_ || silence_.VehiclesReturn()) && BodyOf(vehicle) != nullptr;
}

bool Run::IsKilled(VehicleId vehicle) const {
  return faults_.IsKilled(vehicle) || silence_.IsKilled(vehicle, TimeSeconds());
}

// Whether the vehicle is heard, or will be again as far as is known.
bool Run::IsWaitedFor(VehicleId vehicle) const {
  return !liveness_.IsSilent(vehicle) || (silence_.VehiclesReturn() && !IsKilled(vehicle));
}

void Run::FollowFaults() {
  for (const PlannedFault& fault : faults_.Observe(TimeSeconds(), world_.Bodies(), &log_)) {
    signals_.Fail(fault.signal, fault.kind);
  }
}

void Run::FollowLiveness() {
  const Tick now = world_.Now();
  for (VehicleId silent; (silent = liveness_.TakeNewlySilent(now)) != kNoVehicle;) {
    log_.Add({.kind = EventKind::kSilent, .vehicle = silent});
    if (!open_ && !IsWaitedFor(silent) && !IsKilled(silent)) end_reason_ = "process_died";
  }
  for (VehicleId gone; (gone = liveness_.TakeOverdueBody(now)) != kNoVehicle;) {
    TakeAway(gone);
    log_.Add({.kind = EventKind::kRemoved, .vehicle = gone});
  }
}

void Run::CheckEnd() {
  if (end_reason_.empty() && !asked_end_.empty()) end_reason_ = asked_end_;
  if (end_reason_.empty() && state_ == RunState::kRunning) {
    if (!open_ && EveryoneLivingArrived()) {
      end_reason_ = "all_arrived";
    } else if (!open_ && IsEveryoneSilent()) {
      end_reason_ = "no_vehicle_lives";
    } else if (duration_ticks_ && ticks_run_ >= *duration_ticks_) {
      end_reason_ = "duration_over";
    }
  }
  if (!end_reason_.empty()) Finish();
}

// A vehicle without a goal never arrives, and a silent one is not waited for.
bool Run::EveryoneLivingArrived() const {
  bool anyone = false;
  for (const Body& body : world_.Bodies()) {
    if (!body.joined || !IsWaitedFor(body.vehicle)) continue;
    if (!evaluator_.HasArrived(body.vehicle)) return false;
    anyone = true;
  }
  return anyone;
}

// Whatever was planned: a run in which no vehicle drives any more shows nothing.
bool Run::IsEveryoneSilent() const {
  return std::ranges::all_of(world_.Bodies(), [&](const Body& body) {
    return !body.joined || !IsWaitedFor(body.vehicle);
  });
}

Outcome Run::TheOutcome() const {
  Outcome outcome;
  outcome.contacts = world_.Contacts();
  outcome.halted = evaluator_.Halted();
  outcome.halted_for = evaluator_.HaltedFor();
  outcome.arrived = evaluator_.Arrived();
  outcome.parted = world_.Approaches().Parted(world_.Bodies());
  if (const auto& closest = world_.Approaches().Closest()) {
    outcome.min_separation_m = closest->gap_m;
  }
  const bool cleared = std::ranges::all_of(world_.Bodies(), [&](const Body& body) {
    return !body.joined || !body.goal.set || liveness_.IsSilent(body.vehicle) ||
           evaluator_.HasArrived(body.vehicle);
  });
  if (cleared) outcome.time_to_clear_s = evaluator_.LastArrival();
  return outcome;
}

void Run::Finish() {
  const Outcome outcome = TheOutcome();
  if (const auto& closest = world_.Approaches().Closest()) {
    log_.Add({.kind = EventKind::kClosest,
              .vehicle = closest->vehicle,
              .other = closest->other,
              .position_world = closest->position_world,
              .other_position_world = closest->other_position_world,
              .value = closest->gap_m});
  }
  const bool came_to_its_end = end_reason_ == "all_arrived" || end_reason_ == "duration_over";
  const std::string unmet = came_to_its_end ? Unmet(scenario_.expect, outcome) : end_reason_;
  figures_ = {.epoch = epoch_,
              .passed = unmet.empty(),
              .reason = unmet.empty() ? "expectations_met" : unmet,
              .contacts = outcome.contacts,
              .min_separation_m = outcome.min_separation_m,
              .time_to_clear_s = outcome.time_to_clear_s,
              .ticks = ticks_run_,
              .state_hash = Hash()};
  state_ = RunState::kEnded;
  log_.Add({.kind = EventKind::kEnded, .text = end_reason_});
  log_.Add(
      {.kind = EventKind::kVerdict, .value = figures_.passed ? 1.0 : 0.0, .text = figures_.reason});
}

void Run::Publish(bool drove) {
  truths_.clear();
  auxiliary_.Sense(epoch_, &world_);
  pose_sensing_.Sense(epoch_, world_.Now(), drove ? ticks_run_ : 0, world_.Bodies());
  if (world_faults_.AlterFixes()) {
    pose_sensing_.Lose([&](PoseFix& fix) { return !world_faults_.Alter(&fix); });
  }
  const double time_s = started_ ? TimeSeconds() : kBeforeStart_s;
  signals_.Advance(time_s, epoch_, world_.Now());
  std::size_t scans = 0;
  scans_.resize(world_.Bodies().size());  // those of the tick before are written over
  for (const Body& body : world_.Bodies()) {
    if (!body.joined) continue;
    truths_.push_back({.vehicle = body.vehicle,
                       .epoch = epoch_,
                       .tick = world_.Now(),
                       .time_s = time_s,
                       .world_from_body = body.world_from_body,
                       .wheels = body.wheels,
                       .forward_m_s = body.ForwardSpeed(),
                       .present = body.present,
                       .arrived = evaluator_.HasArrived(body.vehicle)});
    if (!body.present) continue;
    RangeScan& scan = scans_[scans++];
    scan.vehicle = body.vehicle;
    scan.epoch = epoch_;
    scan.tick = world_.Now();
    scan.run_state = state_;
    scan.wheels = body.encoders;
    scan.counted = body.counted;
    scan.readings = body.sonar.readings;
    if (world_faults_.AlterScans()) world_faults_.Alter(body.profile, &scan);
  }
  scans_.resize(scans);
}

std::uint64_t Run::Hash() const {
  StateHash hash;
  hash.Add(ticks_run_);
  world_.AddTo(&hash);
  return hash.Value();
}

// What a checkpoint keeps of a run, so that it survives the end of its process.
RunCheckpoint Run::Save() const {
  return {.epoch = epoch_,
          .started = started_,
          .ticks_run = ticks_run_,
          .event_seq = log_.Seq(),
          .faults = {faults_.States().begin(), faults_.States().end()},
          .world_faults = world_faults_.Save(),
          .tracks = {evaluator_.Tracks().begin(), evaluator_.Tracks().end()},
          .liveness = {liveness_.Entries().begin(), liveness_.Entries().end()},
          .world = world_.Save()};
}

bool Run::Restore(const RunCheckpoint& checkpoint, std::span<const VehicleOptions> joined) {
  for (const VehicleOptions& options : joined) world_.Join(options);
  if (!faults_.Restore(checkpoint.faults) || !world_.Restore(checkpoint.world)) return false;
  if (!world_faults_.Restore(checkpoint.world_faults, checkpoint.ticks_run)) return false;
  evaluator_.Restore(checkpoint.tracks);
  liveness_.Restore(checkpoint.liveness);
  for (const PlannedFault& fault : faults_.Lasting()) signals_.Fail(fault.signal, fault.kind);
  // A world that restarts itself keeps its epoch: observers drop the numbers they have had in it.
  if (checkpoint.epoch == epoch_) log_.ContinueFrom(checkpoint.event_seq);
  started_ = checkpoint.started;
  ticks_run_ = checkpoint.ticks_run;
  return true;
}

}  // namespace giveway::sim

#include "sim_world/run.h"

#include <algorithm>
#include <utility>

#include "services/types/check.h"
#include "sim_world/ticks.h"

namespace giveway::sim {
namespace {

constexpr double kBeforeStart_s = -1;  // Truth::time_s while the start is still to come

}  // namespace

Run::Run(const Scenario& scenario, WorldEpoch epoch)
    : scenario_(scenario),
      epoch_(epoch),
      world_(scenario, epoch),
      faults_(scenario),
      judge_(scenario),
      attendance_(scenario),
      log_(epoch),
      duration_ticks_(TicksCovering(FromSeconds(scenario.duration_s), scenario.tick_period)) {
  scans_.reserve(scenario.vehicles.size());
  truths_.reserve(scenario.vehicles.size());
}

void Run::Join(VehicleId vehicle) {
  world_.Join(vehicle);
  attendance_.Join(vehicle, world_.Now());
}

bool Run::EveryoneJoined() const {
  return std::ranges::all_of(world_.Bodies(), [](const Body& body) { return body.joined; });
}

void Run::Start() {
  GIVEWAY_CHECK(state_ == RunState::kWaiting);
  state_ = RunState::kRunning;
  start_ = world_.Now();
  attendance_.Start(*start_);
}

void Run::End(std::string reason) {
  GIVEWAY_CHECK(!reason.empty());
  if (state_ != RunState::kEnded) asked_end_ = std::move(reason);
}

std::uint32_t Run::TicksRun() const {
  return start_ ? TicksBetween(*start_, end_.value_or(world_.Now())) : 0;
}

double Run::TimeSeconds() const { return TicksRun() * Seconds(scenario_.tick_period); }

void Run::Advance(std::span<const MotorCommand> commands) {
  Take(commands);
  world_.Advance(state_ == RunState::kRunning);
  log_.BeginTick(world_.Now(), TimeSeconds());
  if (state_ == RunState::kRunning) {
    if (TicksRun() == 1) {
      log_.Add(
          {.kind = EventKind::kStarted, .value = static_cast<double>(scenario_.vehicles.size())});
    }
    judge_.Observe(TimeSeconds(), world_.Bodies(), world_.NewContacts(), &log_);
    FollowFaults();
  }
  if (state_ != RunState::kEnded) CheckEnd();
  Publish();
}

void Run::Take(std::span<const MotorCommand> commands) {
  for (const MotorCommand& command : commands) {
    if (attendance_.IsSilent(command.vehicle)) continue;
    if (world_.Take(command)) attendance_.Heard(command.vehicle, After(world_.Now(), 1));
  }
}

void Run::FollowFaults() {
  faults_.Observe(TimeSeconds(), world_.Bodies(), &log_);
  const Tick now = world_.Now();
  for (VehicleId silent; (silent = attendance_.TakeNewlySilent(now)) != kNobody;) {
    log_.Add({.kind = EventKind::kSilent, .vehicle = silent});
    if (!faults_.IsKilled(silent)) end_reason_ = "process_died";
  }
  for (VehicleId gone; (gone = attendance_.TakeOverdueBody(now)) != kNobody;) {
    world_.Remove(gone);
    log_.Add({.kind = EventKind::kRemoved, .vehicle = gone});
  }
}

void Run::CheckEnd() {
  if (end_reason_.empty() && !asked_end_.empty()) end_reason_ = asked_end_;
  if (end_reason_.empty() && state_ == RunState::kRunning) {
    if (EveryoneLivingArrived()) {
      end_reason_ = "all_arrived";
    } else if (TicksRun() >= duration_ticks_) {
      end_reason_ = "duration_over";
    }
  }
  if (!end_reason_.empty()) Finish();
}

// A vehicle without a goal never arrives, and a silent one is not waited for.
bool Run::EveryoneLivingArrived() const {
  bool anyone = false;
  for (const Body& body : world_.Bodies()) {
    if (!body.joined || attendance_.IsSilent(body.vehicle)) continue;
    if (!judge_.HasArrived(body.vehicle)) return false;
    anyone = true;
  }
  return anyone;
}

Outcome Run::TheOutcome() const {
  Outcome outcome;
  outcome.contacts = world_.Contacts();
  outcome.halted = judge_.Halted();
  outcome.arrived = judge_.Arrived();
  outcome.parted = world_.Approaches().Parted(world_.Bodies());
  if (const auto& closest = world_.Approaches().Closest()) {
    outcome.min_separation_m = closest->gap_m;
  }
  const bool cleared = std::ranges::all_of(world_.Bodies(), [&](const Body& body) {
    return !body.joined || !body.goal.set || attendance_.IsSilent(body.vehicle) ||
           judge_.HasArrived(body.vehicle);
  });
  if (cleared) outcome.time_to_clear_s = judge_.LastArrival();
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
              .ticks = TicksRun(),
              .state_hash = Hash()};
  end_ = world_.Now();
  state_ = RunState::kEnded;
  log_.Add({.kind = EventKind::kEnded, .text = end_reason_});
  log_.Add(
      {.kind = EventKind::kVerdict, .value = figures_.passed ? 1.0 : 0.0, .text = figures_.reason});
}

void Run::Publish() {
  scans_.clear();
  truths_.clear();
  const double time_s = start_ ? TimeSeconds() : kBeforeStart_s;
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
                       .arrived = judge_.HasArrived(body.vehicle)});
    if (!body.present) continue;
    scans_.push_back({.vehicle = body.vehicle,
                      .epoch = epoch_,
                      .tick = world_.Now(),
                      .run_state = state_,
                      .wheels = body.encoders,
                      .readings = body.sonar.readings});
  }
}

std::uint64_t Run::Hash() const {
  StateHash hash;
  hash.Add(TicksRun());
  world_.AddTo(&hash);
  return hash.Value();
}

}  // namespace giveway::sim

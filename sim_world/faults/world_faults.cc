#include "sim_world/faults/world_faults.h"

#include <algorithm>

#include "services/faults/kind_table.h"
#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "services/types/state_hash.h"
#include "services/types/time.h"

namespace giveway::sim {
namespace {

// The effect of a kind on a body. A kind that is not listed here does not compile.
enum class Effect : std::uint8_t { kNone, kOnSonar, kOnFix, kWeakens, kSticks, kMiscounts };

Effect EffectOf(faults::Kind kind) {
  switch (kind) {
    using enum faults::Kind;
    case kSonarOff:
    case kSonarStuck:
    case kSonarGarbage:
    case kSonarWrong:
    case kSonarSlow:
    case kSonarDelayed:
    case kSonarIntermittent:
      return Effect::kOnSonar;
    case kPoseFixLost:
    case kPoseFixWrong:
      return Effect::kOnFix;
    case kMotorWeak:
      return Effect::kWeakens;
    case kMotorStuck:
      return Effect::kSticks;
    case kEncoderWrong:
      return Effect::kMiscounts;
    case kKill:
    case kRestart:
    case kPause:
    case kHang:
    case kSlow:
    case kMemoryLimit:
    case kDescriptorLimit:
    case kDiskFull:
    case kLogReaderStops:
    case kClockStep:
    case kQosMismatch:
    case kQosApply:
    case kDuplicateId:
    case kChurn:
    case kSharedMemoryGone:
    case kSharedMemoryLeftOver:
    case kSharedMemorySmall:
    case kLoss:
    case kBurst:
    case kDelay:
    case kReorder:
    case kDuplicate:
    case kCorrupt:
    case kRate:
    case kOneWayCut:
    case kPartition:
    case kFlapping:
    case kSpoofed:
    case kReplayed:
    case kFlooded:
    case kMalformed:
      return Effect::kNone;  // not injected by the world
  }
  return Effect::kNone;
}

bool Concerns(const faults::Target& target, VehicleId vehicle) {
  return target.what == faults::Target::What::kAll ||
         (target.what == faults::Target::What::kVehicle && target.vehicle == vehicle);
}

std::uint64_t DrawsOf(const faults::Fault& fault, std::uint64_t seed) {
  StateHash hash;
  hash.Add(seed);
  for (const char letter : fault.rule) {
    hash.Add(std::uint64_t{static_cast<unsigned char>(letter)});
  }
  hash.Add(fault.nth);
  return hash.Value();
}

// Applies one of several faults on one body at one time; their effects combine.
void Combine(const faults::Fault& fault, WheelSpeeds held, DriveFault* drive) {
  switch (EffectOf(fault.kind)) {
    case Effect::kWeakens:
      drive->reaches *= fault.parameters.factor.value_or(1);
      break;
    case Effect::kMiscounts:
      drive->counts *= fault.parameters.factor.value_or(1);
      break;
    case Effect::kSticks:
      drive->stuck = held;
      break;
    case Effect::kNone:
    case Effect::kOnSonar:
    case Effect::kOnFix:
      break;
  }
}

// Displaces the fix by `factor` of its standard deviations, each time in a new random direction,
// like a radio signal reflected by a wall.
void MisplaceFix(const faults::Parameters& parameters, Random random, PoseFix* fix) {
  if (random.Uniform(0, 1) >= parameters.probability.value_or(1)) return;
  const double off_m = parameters.factor.value_or(0) * fix->sigma_position_m;
  const double side_rad = random.Uniform(-kPi, kPi);
  fix->world_from_body.position_world =
      fix->world_from_body.position_world + off_m * Vec2{Cos(side_rad), Sin(side_rad)};
}

}  // namespace

std::string EventText(const faults::Fault& fault) {
  return std::string(faults::ToString(fault.kind)) + " " + std::to_string(fault.nth) + " of " +
         fault.rule;
}

WorldFaults::WorldFaults(const FaultSchedule& schedule, Nanoseconds tick_period)
    : tick_period_(tick_period) {
  for (const faults::Fault& fault : schedule.faults) {
    if (faults::ActorOf(fault.kind) != faults::Actor::kWorld) continue;
    Planned planned{.fault = fault};
    planned.fault.parameters = faults::Filled(fault.kind, fault.parameters);
    planned.begins = std::max(1U, TicksCovering(FromSeconds(fault.at_s), tick_period));
    planned.ends =
        std::max(planned.begins + 1, TicksCovering(FromSeconds(fault.EndsAt_s()), tick_period));
    planned.draws = DrawsOf(fault, schedule.seed);
    planned.of_fix = EffectOf(fault.kind) == Effect::kOnFix;
    planned.of_sonar = EffectOf(fault.kind) == Effect::kOnSonar;
    planned_.push_back(std::move(planned));
  }
  std::ranges::stable_sort(planned_, {}, &Planned::begins);
}

void WorldFaults::Rest() {
  resting_ = true;
  drives_.clear();
  begun_.clear();
  ended_.clear();
}

void WorldFaults::BeginTick(std::uint32_t driven_tick, std::span<const Body> bodies) {
  resting_ = false;
  driven_tick_ = driven_tick;
  drives_.clear();
  begun_.clear();
  ended_.clear();
  if (active_.empty() && (next_ == planned_.size() || planned_[next_].begins > driven_tick)) return;
  FollowTime(driven_tick);
  for (const Body& body : bodies) {
    if (body.present) Follow(body);
  }
}

void WorldFaults::FollowTime(std::uint32_t driven_tick) {
  const auto is_over = [&](const Active& active) {
    return driven_tick >= planned_[active.planned].ends;
  };
  for (const Active& active : active_) {
    if (is_over(active) && active.begun) ended_.push_back(&planned_[active.planned].fault);
  }
  std::erase_if(active_, is_over);
  for (; next_ < planned_.size() && planned_[next_].begins <= driven_tick; ++next_) {
    active_.push_back({.planned = static_cast<std::uint32_t>(next_)});
  }
  sonars_ = static_cast<std::size_t>(std::ranges::count_if(
      active_, [&](const Active& active) { return planned_[active.planned].of_sonar; }));
  fixes_ = static_cast<std::size_t>(std::ranges::count_if(
      active_, [&](const Active& active) { return planned_[active.planned].of_fix; }));
}

void WorldFaults::Follow(const Body& body) {
  DriveFault drive{.vehicle = body.vehicle};
  bool drives_wrongly = false;
  for (Active& active : active_) {
    const Planned& planned = planned_[active.planned];
    if (!Concerns(planned.fault.target, body.vehicle)) continue;
    if (!active.begun) begun_.push_back(&planned.fault);
    active.begun = true;
    if (planned.of_fix) continue;
    const Memory* memory = Remember(&active, body);
    if (planned.of_sonar) continue;
    Combine(planned.fault, memory->wheels, &drive);
    drives_wrongly = true;
  }
  if (drives_wrongly) drives_.push_back(drive);
}

// A body that is seen for the first time since the fault started: its wheels keep their speeds.
WorldFaults::Memory* WorldFaults::Remember(Active* active, const Body& body) {
  const auto at = std::ranges::lower_bound(active->memories, body.vehicle, {}, &Memory::vehicle);
  if (at != active->memories.end() && at->vehicle == body.vehicle) return &*at;
  Memory memory{.vehicle = body.vehicle, .wheels = body.wheels};
  const Planned& planned = planned_[active->planned];
  if (planned.of_sonar) {
    // A fault of all vehicles draws separately for each of them.
    StateHash draws;
    draws.Add(planned.draws);
    draws.Add(body.vehicle);
    memory.sonar.emplace(planned.fault, draws.Value(), tick_period_);
  }
  return &*active->memories.insert(at, std::move(memory));
}

void WorldFaults::Alter(const RobotModel& profile, RangeScan* scan) {
  for (Active& active : active_) {
    const auto memory =
        std::ranges::lower_bound(active.memories, scan->vehicle, {}, &Memory::vehicle);
    if (memory == active.memories.end() || memory->vehicle != scan->vehicle) continue;
    if (memory->sonar) memory->sonar->Alter(profile, driven_tick_, scan);
  }
}

bool WorldFaults::Alter(PoseFix* fix) const {
  for (const Active& active : active_) {
    const Planned& planned = planned_[active.planned];
    if (!planned.of_fix || !Concerns(planned.fault.target, fix->vehicle)) continue;
    if (planned.fault.kind == faults::Kind::kPoseFixLost) return false;
    MisplaceFix(planned.fault.parameters,
                Random(planned.draws, std::uint64_t{Number(fix->vehicle)} << 32 | driven_tick_),
                fix);
  }
  return true;
}

std::vector<WorldFaults::State> WorldFaults::Save() const {
  std::vector<State> states;
  for (const Active& active : active_) {
    State& state = states.emplace_back(State{.fault = active.planned, .begun = active.begun});
    if (planned_[active.planned].of_sonar) continue;
    for (const Memory& memory : active.memories) {
      state.held.push_back({memory.vehicle, memory.wheels});
    }
  }
  return states;
}

bool WorldFaults::Restore(std::span<const State> states, std::uint32_t driven_tick) {
  const auto fits = [&](const State& state) {
    return state.fault < planned_.size() && planned_[state.fault].begins <= driven_tick &&
           driven_tick < planned_[state.fault].ends;
  };
  if (!std::ranges::all_of(states, fits)) return false;
  active_.clear();
  for (const State& state : states) {
    Active& active = active_.emplace_back();
    active.planned = state.fault;
    active.begun = state.begun;
    for (const HeldWheels& held : state.held) {
      active.memories.push_back({.vehicle = held.vehicle, .wheels = held.wheels});
    }
  }
  while (next_ < planned_.size() && planned_[next_].begins <= driven_tick) ++next_;
  return true;
}

}  // namespace giveway::sim

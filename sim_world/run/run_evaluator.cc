#include "sim_world/run/run_evaluator.h"

#include <algorithm>
#include <cmath>

#include "services/types/time.h"

namespace giveway::sim {
namespace {

constexpr double kStandstill_m_s = 0.01;
constexpr Nanoseconds kHaltTime{500'000'000};
constexpr std::size_t kMostTracks = 2048;

// What a vehicle touched that is no vehicle.
const char* TextOf(Touched touched) {
  switch (touched) {
    case Touched::kWall:
      return "wall";
    case Touched::kObstacle:
      return "obstacle";
    case Touched::kDoor:
      return "door";
    case Touched::kVehicle:
      break;
  }
  return "";
}

bool Stands(const Body& body) { return std::abs(body.ForwardSpeed()) < kStandstill_m_s; }

}  // namespace

void LogContacts(std::span<const Contact> contacts, EventLog* log) {
  for (const Contact& contact : contacts) {
    log->Add({.kind = EventKind::kContact,
              .vehicle = contact.vehicle,
              .other = contact.other,
              .position_world = contact.position_world,
              .other_position_world = contact.other_position_world,
              .text = TextOf(contact.touched)});
  }
}

RunEvaluator::RunEvaluator(const Scenario& scenario)
    : halt_ticks_(TicksCovering(kHaltTime, scenario.tick_period)) {
  for (const VehicleOptions& options : scenario.vehicles) {
    tracks_.push_back({.vehicle = options.id});
  }
}

void RunEvaluator::Observe(double time_s, std::span<const Body> bodies,
                           std::span<const Contact> contacts, EventLog* log) {
  LogContacts(contacts, log);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Track& track = TrackOf(i, bodies[i].vehicle);
    if (!bodies[i].present) continue;
    WatchGoal(time_s, bodies[i], &track, log);
    if (!track.arrived_s) WatchHalt(bodies[i], &track, log);
  }
}

// Usually at the body's own index: bodies join among the known ones, and some are forgotten.
RunEvaluator::Track& RunEvaluator::TrackOf(std::size_t body, VehicleId vehicle) {
  if (body < tracks_.size() && tracks_[body].vehicle == vehicle) return tracks_[body];
  const auto place = std::ranges::lower_bound(tracks_, vehicle, {}, &Track::vehicle);
  if (place != tracks_.end() && place->vehicle == vehicle) return *place;
  return *tracks_.insert(place, Track{.vehicle = vehicle});
}

void RunEvaluator::Forget(VehicleId vehicle) {
  const auto track = std::ranges::lower_bound(tracks_, vehicle, {}, &Track::vehicle);
  if (track == tracks_.end() || track->vehicle != vehicle) return;
  const bool counts = track->halted_once || track->arrived_before || track->arrived_s.has_value();
  if (!counts || tracks_.size() > kMostTracks) tracks_.erase(track);
}

void RunEvaluator::Restart(VehicleId vehicle) {
  const auto track = std::ranges::lower_bound(tracks_, vehicle, {}, &Track::vehicle);
  if (track == tracks_.end() || track->vehicle != vehicle) return;
  track->still_ticks = 0;
  track->halted = false;
  track->arrived_before = track->arrived_before || track->arrived_s.has_value();
  track->arrived_s.reset();
}

void RunEvaluator::WatchGoal(double time_s, const Body& body, Track* track, EventLog* log) const {
  if (!body.goal.set) return;
  const Vec2 position = body.world_from_body.position_world;
  const bool inside = Norm(body.goal.at_world - position) <= body.goal.radius_m;
  if (track->arrived_s && !inside) {
    track->arrived_s.reset();
    log->Add({.kind = EventKind::kResumed, .vehicle = body.vehicle, .position_world = position});
  }
  if (track->arrived_s || !inside || !body.obeyed || !Stands(body)) return;
  track->arrived_s = time_s;
  log->Add({.kind = EventKind::kArrived,
            .vehicle = body.vehicle,
            .position_world = position,
            .value = time_s});
}

// A vehicle that the world itself brakes stands for lack of a command, whatever its last one said.
void RunEvaluator::WatchHalt(const Body& body, Track* track, EventLog* log) const {
  const Vec2 position = body.world_from_body.position_world;
  const bool stands = Stands(body);
  if (track->halted) {
    if (stands) return;
    track->halted = false;
    track->still_ticks = 0;
    track->stopping_for = Rule::kCruise;
    log->Add({.kind = EventKind::kResumed, .vehicle = body.vehicle, .position_world = position});
    return;
  }
  const Rule rule = body.command.decision.rule;
  const bool gives_way = body.obeyed && IsGiveWay(rule);
  if (!gives_way) track->stopping_for = Rule::kCruise;
  if (gives_way && track->stopping_for == Rule::kCruise) track->stopping_for = rule;
  track->still_ticks = stands && gives_way ? track->still_ticks + 1 : 0;
  if (track->still_ticks < halt_ticks_) return;
  track->halted = true;
  track->halted_once = true;
  track->halted_for |= 1U << static_cast<unsigned>(track->stopping_for);
  log->Add({.kind = EventKind::kHalted,
            .vehicle = body.vehicle,
            .other = body.command.decision.peer,
            .position_world = position,
            .text = std::string(Name(track->stopping_for))});
}

bool RunEvaluator::HasArrived(VehicleId vehicle) const {
  const auto track = std::ranges::lower_bound(tracks_, vehicle, {}, &Track::vehicle);
  return track != tracks_.end() && track->vehicle == vehicle && track->arrived_s.has_value();
}

std::vector<VehicleId> RunEvaluator::Halted() const {
  std::vector<VehicleId> halted;
  for (const Track& track : tracks_) {
    if (track.halted_once) halted.push_back(track.vehicle);
  }
  return halted;
}

std::vector<Rule> RunEvaluator::HaltedFor() const {
  std::uint32_t all = 0;
  for (const Track& track : tracks_) all |= track.halted_for;
  std::vector<Rule> rules;
  for (unsigned i = 0; i < 32; ++i) {
    if ((all >> i & 1U) != 0) rules.push_back(static_cast<Rule>(i));
  }
  return rules;
}

std::vector<VehicleId> RunEvaluator::Arrived() const {
  std::vector<VehicleId> arrived;
  for (const Track& track : tracks_) {
    if (track.arrived_before || track.arrived_s) arrived.push_back(track.vehicle);
  }
  return arrived;
}

std::optional<double> RunEvaluator::LastArrival() const {
  std::optional<double> last;
  for (const Track& track : tracks_) {
    if (track.arrived_s && (!last || *track.arrived_s > *last)) last = track.arrived_s;
  }
  return last;
}

}  // namespace giveway::sim

#include "sim_world/virtual/red_lights.h"

#include <algorithm>
#include <limits>

#include "services/types/math/math.h"
#include "services/types/signal_plan.h"
#include "sim_world/run/traffic_lights.h"

namespace giveway::sim {
namespace {

constexpr double kCosSameWay = 0.7071067811865476;  // 45 degrees

double OutFrom(const Scenario& scenario, SignalId signal) {
  double from_s = std::numeric_limits<double>::infinity();
  for (const PlannedFault& fault : scenario.faults) {
    const bool out = fault.kind == FaultKind::kSignalDark || fault.kind == FaultKind::kSignalSilent;
    if (out && fault.signal == signal) from_s = std::min(from_s, fault.at_s.value_or(0));
  }
  return from_s;
}

double DistanceToLine(Vec2 point_world, const SignalPlan& plan) {
  const Vec2 along = plan.line_to_world - plan.line_from_world;
  const double share =
      std::clamp(Dot(point_world - plan.line_from_world, along) / SquaredNorm(along), 0.0, 1.0);
  return Norm(point_world - (plan.line_from_world + share * along));
}

// From one side of the line to the other, between its ends; on the line counts as one side.
bool Crosses(Vec2 from_world, Vec2 to_world, const SignalPlan& plan) {
  const Vec2 line = plan.line_to_world - plan.line_from_world;
  const double before = Cross(line, from_world - plan.line_from_world);
  const double after = Cross(line, to_world - plan.line_from_world);
  if ((before > 0) == (after > 0)) return false;
  const Vec2 moved = to_world - from_world;
  const double share = Cross(plan.line_from_world - from_world, moved) / Cross(moved, line);
  return share >= 0 && share <= 1;
}

}  // namespace

RedLights::RedLights(const Scenario& scenario) : tick_period_(scenario.tick_period) {
  for (const SignalPlan& plan : scenario.signals) {
    heads_.push_back({.plan = plan,
                      .out_from_s = OutFrom(scenario, plan.id),
                      .travel_world = {Cos(plan.travel_rad), Sin(plan.travel_rad)}});
  }
  for (const VehicleOptions& options : scenario.vehicles) tracks_.push_back(TrackOf(options));
}

RedLights::Track RedLights::TrackOf(const VehicleOptions& options) const {
  return {.vehicle = options.id,
          .radius_m = options.profile.body_radius_m,
          .deceleration_m_s2 = options.profile.deceleration_m_s2,
          .excused = std::vector<bool>(heads_.size())};
}

void RedLights::Admit(const VehicleOptions& options) {
  const auto place = std::ranges::lower_bound(tracks_, options.id, {}, &Track::vehicle);
  if (place != tracks_.end() && place->vehicle == options.id) {
    *place = TrackOf(options);
  } else {
    tracks_.insert(place, TrackOf(options));
  }
}

void RedLights::Forget(VehicleId vehicle) {
  std::erase_if(tracks_, [vehicle](const Track& track) { return track.vehicle == vehicle; });
}

void RedLights::Follow(double time_s) {
  any_stops_ = false;
  for (Head& head : heads_) {
    head.was_red = head.phase == SignalPhase::kRed;
    head.phase = time_s >= head.out_from_s ? SignalPhase::kDark
                                           : PhaseAt(head.plan, FromSeconds(time_s)).phase;
    head.turned_red = head.phase == SignalPhase::kRed && !head.was_red;
    any_stops_ =
        any_stops_ || head.phase == SignalPhase::kRed || head.phase == SignalPhase::kYellow;
  }
}

bool RedLights::PassesRed(const Observed& now, Track* track) const {
  // Two ticks as always, and the light's sample may be lost once.
  const double reaction_s = Seconds(2 * tick_period_ + 2 * kSignalPeriod);
  const double speed = Magnitude(now.forward_m_s);
  const double stopping_m = speed * reaction_s + speed * speed / (2 * track->deceleration_m_s2);
  const Vec2 moved = now.position_world - track->last_position_world;
  bool passes = false;
  for (std::size_t i = 0; i < heads_.size(); ++i) {
    const Head& head = heads_[i];
    if (head.turned_red) {
      track->excused[i] =
          DistanceToLine(now.position_world, head.plan) - track->radius_m <= stopping_m;
    }
    if (head.phase != SignalPhase::kRed || !head.was_red || track->excused[i]) continue;
    if (Dot(moved, head.travel_world) < kCosSameWay * Norm(moved)) continue;
    passes = passes || Crosses(track->last_position_world, now.position_world, head.plan);
  }
  return passes;
}

std::span<const std::uint32_t> RedLights::Observe(double time_s,
                                                  std::span<const Observed> vehicles) {
  passed_.clear();
  if (heads_.empty()) return passed_;
  Follow(time_s);
  for (std::uint32_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    Track& track = tracks_[i];
    if (!track.seen) track.last_position_world = now.position_world;
    track.seen = now.present;
    if (now.present && PassesRed(now, &track)) passed_.push_back(i);
    track.last_position_world = now.position_world;
  }
  return passed_;
}

}  // namespace giveway::sim

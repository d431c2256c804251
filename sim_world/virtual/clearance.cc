#include "sim_world/virtual/clearance.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway::sim {
namespace {

// A slower approach counts as driving past.
constexpr double kTowards_m_s = 0.005;

}  // namespace

Clearance::Clearance(const Scenario& scenario, double margin_m) : margin_m_(margin_m) {
  for (const VehicleOptions& options : scenario.vehicles) {
    tracks_.push_back({.vehicle = options.id, .profile = options.profile});
  }
  for (const Wall& wall : scenario.walls) {
    const auto [from, to] = wall;
    walls_.push_back({wall,
                      {std::min(from.x, to.x), std::min(from.y, to.y)},
                      {std::max(from.x, to.x), std::max(from.y, to.y)}});
  }
}

void Clearance::Admit(const VehicleOptions& options) {
  const Track track{.vehicle = options.id, .profile = options.profile};
  const auto place = std::ranges::lower_bound(tracks_, options.id, {}, &Track::vehicle);
  if (place != tracks_.end() && place->vehicle == options.id) {
    *place = track;
  } else {
    tracks_.insert(place, track);
  }
}

void Clearance::Forget(VehicleId vehicle) {
  std::erase_if(tracks_, [vehicle](const Track& track) { return track.vehicle == vehicle; });
}

bool Clearance::IsNear(const Approaching& own, const Outline& other) const {
  const Nearest nearest = NearestBetween(OutlineAt(own.body, 0), other);
  return nearest.gap_m < margin_m_ && Dot(own.velocity_world, nearest.axis_world) > kTowards_m_s;
}

// Most are far, and most of the rest are discs.
bool Clearance::IsNearBody(const Approaching& own, const Track& track,
                           const Observed& other) const {
  const Vec2 offset = other.position_world - own.body.start_world.position_world;
  const double reach_m = own.reach_m + track.profile.body_radius_m;
  if (offset.x > reach_m || offset.x < -reach_m || SquaredNorm(offset) >= reach_m * reach_m) {
    return false;
  }
  const Motion body = StandingAt(track.profile, {other.position_world, other.heading_rad});
  if (!BothAreDiscs(own.body, body)) return IsNear(own, OutlineAt(body, 0));
  return Dot(own.velocity_world, offset) > kTowards_m_s * Norm(offset);
}

bool Clearance::IsNearWall(const Approaching& own) const {
  const Vec2 at = own.body.start_world.position_world;
  return std::ranges::any_of(walls_, [&](const BoundWall& bound) {
    const bool far =
        at.x + own.reach_m < bound.low_world.x || at.x - own.reach_m > bound.high_world.x ||
        at.y + own.reach_m < bound.low_world.y || at.y - own.reach_m > bound.high_world.y;
    return !far && IsNear(own, OutlineOf(bound.wall));
  });
}

bool Clearance::IsNearThing(const Approaching& own, const Surroundings& around) const {
  for (const MovingObstacle& obstacle : around.obstacles) {
    const Motion standing = obstacle.Plan(false, 0);
    const double reach_m = own.reach_m + standing.radius_m;
    const Vec2 offset = standing.start_world.position_world - own.body.start_world.position_world;
    if (SquaredNorm(offset) >= reach_m * reach_m) continue;
    if (IsNear(own, OutlineAt(standing, 0))) return true;
  }
  return std::ranges::any_of(around.doors, [&](const SlidingDoor& door) {
    return door.Opening() < 1 && IsNear(own, OutlineAt(door.Plan(false, 0, 0), 0));
  });
}

bool Clearance::FindNear(std::size_t index, std::span<const Observed> vehicles,
                         const Surroundings& around, VehicleId* other) const {
  const Observed& now = vehicles[index];
  const RobotModel& profile = tracks_[index].profile;
  const Approaching own{
      .body = StandingAt(profile, {now.position_world, now.heading_rad}),
      .velocity_world = now.forward_m_s * Vec2{Cos(now.heading_rad), Sin(now.heading_rad)},
      .reach_m = profile.body_radius_m + margin_m_};
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (i == index || !vehicles[i].present || !IsNearBody(own, tracks_[i], vehicles[i])) continue;
    *other = vehicles[i].vehicle;
    return true;
  }
  return IsNearWall(own) || IsNearThing(own, around);
}

// Reported again only once it has moved without anything near.
std::span<const TooNear> Clearance::Observe(std::span<const Observed> vehicles,
                                            const Surroundings& around) {
  too_near_.clear();
  for (std::uint32_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    if (!now.present || Magnitude(now.forward_m_s) < kStandstill_m_s) continue;
    VehicleId other = kNoVehicle;
    const bool near = FindNear(i, vehicles, around, &other);
    if (near && !tracks_[i].reported) too_near_.push_back({i, other});
    tracks_[i].reported = near;
  }
  return too_near_;
}

}  // namespace giveway::sim

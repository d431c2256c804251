#include "sim_world/sonar.h"

#include <algorithm>
#include <cmath>

#include "services/types/check.h"
#include "services/types/math.h"
#include "sim_world/geometry.h"

namespace giveway::sim {
namespace {

// An apex this near to a wall stands on it: there the cone has no width left to clip a wall to.
constexpr double kOnTheWall_m = 1e-9;

// `point` as the transducer sees it: x along the axis, y to its left.
Vec2 InCone(const Cone& cone, Vec2 point) {
  const Vec2 offset = point - cone.apex;
  return {Dot(cone.axis, offset), Cross(cone.axis, offset)};
}

std::optional<double> IfWithin(double range_m, double max_range_m) {
  if (range_m > max_range_m) return std::nullopt;
  return range_m;
}

// A part of a segment, by its parameter in [0, 1].
struct Interval {
  double low = 0;
  double high = 1;
};

// Keeps the part of the segment on which `normal` . point >= 0; empty when low > high.
void Clip(Interval* part, Vec2 normal, Vec2 from, Vec2 to) {
  const double at_from = Dot(normal, from);
  const double change = Dot(normal, to - from);
  if (change == 0) {
    if (at_from < 0) *part = {1, 0};
  } else if (change > 0) {
    part->low = std::max(part->low, -at_from / change);
  } else {
    part->high = std::min(part->high, -at_from / change);
  }
}

void Keep(RangeReading* reading, std::optional<double> range_m) {
  if (!range_m || (reading->kind == Echo::kEcho && reading->range_m <= *range_m)) return;
  reading->kind = Echo::kEcho;
  reading->range_m = *range_m;
}

}  // namespace

std::optional<double> RangeToDisc(const Cone& cone, Vec2 centre, double radius_m) {
  Vec2 seen = InCone(cone, centre);
  seen.y = std::abs(seen.y);  // the cone is its own mirror image
  const double distance = Norm(seen);
  if (distance <= radius_m) return 0.0;
  const Vec2 edge = {cone.cos_half, cone.sin_half};
  const double beyond_edge_m = Cross(edge, seen);
  if (beyond_edge_m <= 0) return IfWithin(distance - radius_m, cone.max_range_m);
  // The disc's distance grows with the angle to its centre: the edge towards it is nearest.
  const double along_edge_m = Dot(edge, seen);
  if (along_edge_m <= 0 || beyond_edge_m > radius_m) return std::nullopt;
  const double half_chord = Sqrt(radius_m * radius_m - beyond_edge_m * beyond_edge_m);
  return IfWithin(along_edge_m - half_chord, cone.max_range_m);
}

std::optional<double> RangeToSegment(const Cone& cone, Vec2 from_frame, Vec2 to_frame) {
  const Vec2 from = InCone(cone, from_frame);
  const Vec2 to = InCone(cone, to_frame);
  const double foot = NearestParameter(from, to, {});
  if (Norm(from + foot * (to - from)) <= kOnTheWall_m) return 0.0;
  Interval inside;
  Clip(&inside, {cone.sin_half, -cone.cos_half}, from, to);
  Clip(&inside, {cone.sin_half, cone.cos_half}, from, to);
  if (inside.low > inside.high) return std::nullopt;
  // Along the segment the distance grows away from the foot on either side.
  const double nearest = std::clamp(foot, inside.low, inside.high);
  return IfWithin(Norm(from + nearest * (to - from)), cone.max_range_m);
}

SonarRing::SonarRing(const VehicleProfile& profile) {
  GIVEWAY_CHECK(profile.sonar_half_angle_rad > 0 && profile.sonar_half_angle_rad < kPi / 2,
                profile.sonar_half_angle_rad);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const SensorMount& mount = profile.sonar[i];
    cones_body_[i] = {.apex = mount.position_body,
                      .axis = {Cos(mount.bearing_rad), Sin(mount.bearing_rad)},
                      .cos_half = Cos(profile.sonar_half_angle_rad),
                      .sin_half = Sin(profile.sonar_half_angle_rad),
                      .max_range_m = profile.sonar_max_range_m};
    enabled_[i] = mount.enabled;
    reach_m_ = std::max(reach_m_, Norm(mount.position_body) + profile.sonar_max_range_m);
  }
}

Readings SonarRing::Sense(const Pose& world_from_body, Tick tick, std::span<const Disc> bodies,
                          std::size_t self, std::span<const Wall> walls) const {
  Readings readings{};
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (enabled_[i]) readings[i] = {.kind = Echo::kClear, .range_m = 0, .tick = tick};
  }
  const Vec2 x_axis = Forward(world_from_body);
  const auto to_body = [&](Vec2 point_world) {
    const Vec2 offset_world = point_world - world_from_body.position_world;
    return Vec2{Dot(x_axis, offset_world), Cross(x_axis, offset_world)};
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i != self) HearDisc(to_body(bodies[i].centre_world), bodies[i].radius_m, &readings);
  }
  for (const Wall& wall : walls) {
    HearWall(to_body(wall.from_world), to_body(wall.to_world), &readings);
  }
  return readings;
}

void SonarRing::HearDisc(Vec2 centre_body, double radius_m, Readings* readings) const {
  const double reach_m = reach_m_ + radius_m;
  if (SquaredNorm(centre_body) > reach_m * reach_m) return;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (enabled_[i]) Keep(&(*readings)[i], RangeToDisc(cones_body_[i], centre_body, radius_m));
  }
}

void SonarRing::HearWall(Vec2 from_body, Vec2 to_body, Readings* readings) const {
  if (SquaredNorm(NearestOnSegment(from_body, to_body, {})) > reach_m_ * reach_m_) return;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (enabled_[i]) Keep(&(*readings)[i], RangeToSegment(cones_body_[i], from_body, to_body));
  }
}

}  // namespace giveway::sim

#include "sim_world/sensors/ray_fan.h"

#include <algorithm>
#include <cmath>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"
#include "sim_world/geometry/ray.h"

namespace giveway::sim {
namespace {

// A sensor this near to a segment stands on it: from there its ends have no bearing.
constexpr double kOnTheSegment_m = 1e-9;

void Keep(RayHit* nearest, double range_m, Owner owner) {
  const bool nearer = !nearest->hit || range_m < nearest->range_m ||
                      (range_m == nearest->range_m && owner < nearest->owner);
  if (nearer) *nearest = {true, range_m, owner};
}

}  // namespace

RayFan::RayFan(double first_rad, double step_rad, std::size_t count)
    : first_rad_(first_rad), step_rad_(step_rad) {
  constexpr double kQuarter_rad = kPi / 2 + 1e-9;
  GIVEWAY_CHECK(count > 0 && step_rad > 0);
  GIVEWAY_CHECK(first_rad >= -kQuarter_rad && Bearing(count - 1) <= kQuarter_rad, first_rad);
  for (std::size_t ray = 0; ray < count; ++ray) {
    directions_body_.push_back({Cos(Bearing(ray)), Sin(Bearing(ray))});
  }
}

// The rays from one bearing to the other and one more on either side, so that rounding loses none.
RayFan::Rays RayFan::Between(double from_rad, double to_rad) const {
  const auto count = static_cast<double>(directions_body_.size());
  const double begin = std::clamp(std::floor((from_rad - first_rad_) / step_rad_), 0.0, count);
  const double end = std::clamp(std::floor((to_rad - first_rad_) / step_rad_) + 2, 0.0, count);
  return {static_cast<std::size_t>(begin), static_cast<std::size_t>(end)};
}

RayFan::Rays RayFan::MeetingDisc(Vec2 centre_body, double radius_m) const {
  const double squared_tangent = SquaredNorm(centre_body) - radius_m * radius_m;
  if (squared_tangent <= 0) return All();
  const double bearing = Atan2(centre_body.y, centre_body.x);
  const double half_width = Atan2(radius_m, Sqrt(squared_tangent));
  return Between(bearing - half_width, bearing + half_width);
}

RayFan::Rays RayFan::MeetingSegment(Vec2 from_body, Vec2 to_body) const {
  if (SquaredNorm(NearestOnSegment(from_body, to_body, {})) <= kOnTheSegment_m * kOnTheSegment_m) {
    return All();
  }
  const double a = Atan2(from_body.y, from_body.x);
  const double b = Atan2(to_body.y, to_body.x);
  // More than half a turn apart: the segment passes behind the sensor, or hardly to one side of it.
  if (std::abs(a - b) > kPi - 1e-6) return All();
  return Between(std::min(a, b), std::max(a, b));
}

void RayFan::Cast(const SensorView& view, double range_m, std::span<RayHit> hits) const {
  GIVEWAY_CHECK(hits.size() == directions_body_.size(), hits.size());
  std::ranges::fill(hits, RayHit{});
  const BodyFrame body(view.world_from_body);
  const Vec2 at_world = view.world_from_body.position_world;
  const Owner inside = view.scene.BoxAround(at_world, view.self);
  if (inside != kNoOwner) std::ranges::fill(hits, RayHit{true, 0, inside});

  const SceneDiscs discs = view.scene.Discs();
  view.scene.DiscsNear(at_world, range_m, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i) {
      if (discs.owner[i] == view.self) continue;
      const Vec2 centre = body.Point({discs.x_world[i], discs.y_world[i]});
      const Rays rays = MeetingDisc(centre, discs.radius_m[i]);
      for (std::size_t ray = rays.begin; ray < rays.end; ++ray) {
        const auto range = RayToDisc(directions_body_[ray], centre, discs.radius_m[i]);
        if (range && *range <= range_m) Keep(&hits[ray], *range, discs.owner[i]);
      }
    }
  });
  view.scene.SegmentsNear(at_world, range_m, [&](const SceneSegment& segment) {
    if (segment.owner == view.self && segment.owner != kNoOwner) return;
    const Vec2 from = body.Point(segment.from_world);
    const Vec2 to = body.Point(segment.to_world);
    const Rays rays = MeetingSegment(from, to);
    for (std::size_t ray = rays.begin; ray < rays.end; ++ray) {
      const auto range = RayToSegment(directions_body_[ray], from, to);
      if (range && *range <= range_m) Keep(&hits[ray], *range, segment.owner);
    }
  });
}

}  // namespace giveway::sim

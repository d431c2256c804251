#include "sim_world/sensors/line_of_sight.h"

#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::sim {
namespace {

// Twice the area that rounding leaves between two segments on one line.
constexpr double kEdgeOn_m2 = 1e-9;

// Whether the segment from p to q and the wall cross or touch.
bool Crosses(Vec2 p, Vec2 q, const SceneSegment& wall) {
  const Vec2 a = wall.from_world;
  const Vec2 b = wall.to_world;
  const double a_side = Cross(q - p, a - p);
  const double b_side = Cross(q - p, b - p);
  if (Magnitude(a_side) <= kEdgeOn_m2 && Magnitude(b_side) <= kEdgeOn_m2) return false;
  return a_side * b_side <= 0 && Cross(b - a, p - a) * Cross(b - a, q - a) <= 0;
}

}  // namespace

bool IsBlocked(const Scene& scene, Vec2 from_world, Vec2 to_world, Owner from, Owner to) {
  const auto is_foreign = [&](Owner owner) {
    return owner == kNoOwner || (owner != from && owner != to);
  };
  const Vec2 middle = 0.5 * (from_world + to_world);
  const double reach_m = 0.5 * Norm(to_world - from_world);
  const SceneDiscs discs = scene.Discs();
  bool blocked = false;
  scene.DiscsNear(middle, reach_m, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end && !blocked; ++i) {
      const Vec2 centre = {discs.x_world[i], discs.y_world[i]};
      const Vec2 gap = NearestOnSegment(from_world, to_world, centre) - centre;
      blocked =
          is_foreign(discs.owner[i]) && SquaredNorm(gap) < discs.radius_m[i] * discs.radius_m[i];
    }
  });
  if (blocked) return true;
  scene.SegmentsNear(middle, reach_m, [&](const SceneSegment& segment) {
    blocked = blocked || (is_foreign(segment.owner) && Crosses(from_world, to_world, segment));
  });
  return blocked;
}

}  // namespace giveway::sim

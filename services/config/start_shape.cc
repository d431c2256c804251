#include "services/config/start_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace giveway {
namespace {

bool IsFinite(const StartShape& s) {
  const Vec2 at = s.world_from_body.position_world;
  return std::isfinite(at.x + at.y + s.world_from_body.heading_rad + s.radius_m + s.box_half_m.x +
                       s.box_half_m.y);
}

bool IsBox(const StartShape& shape) { return shape.shape == BodyShape::kBox; }

// Half the shadow that a box throws on a direction of length 1.
double HalfShadow(const StartShape& box, Vec2 direction_world) {
  const Vec2 x_axis = Forward(box.world_from_body);
  return box.box_half_m.x * std::abs(Dot(x_axis, direction_world)) +
         box.box_half_m.y * std::abs(Cross(x_axis, direction_world));
}

// Two rectangles are apart if and only if their shadows on a side of one of them are.
bool BoxesOverlap(const StartShape& a, const StartShape& b) {
  const Vec2 between = b.world_from_body.position_world - a.world_from_body.position_world;
  const Vec2 ax = Forward(a.world_from_body);
  const Vec2 bx = Forward(b.world_from_body);
  const std::array<Vec2, 4> sides{ax, Left(ax), bx, Left(bx)};
  return std::all_of(sides.begin(), sides.end(), [&](Vec2 side) {
    return std::abs(Dot(between, side)) <= HalfShadow(a, side) + HalfShadow(b, side);
  });
}

bool BoxHoldsDisc(const StartShape& box, const StartShape& disc) {
  const Vec2 centre_box = ToBody(box.world_from_body, disc.world_from_body.position_world);
  const Vec2 nearest{std::clamp(centre_box.x, -box.box_half_m.x, box.box_half_m.x),
                     std::clamp(centre_box.y, -box.box_half_m.y, box.box_half_m.y)};
  return Norm(centre_box - nearest) <= disc.radius_m;
}

// As for two rectangles: the sides of the box, and the normal of the line.
bool BoxMeetsLine(const StartShape& box, const StartLine& line) {
  const Vec2 from = ToBody(box.world_from_body, line.from_world);
  const Vec2 to = ToBody(box.world_from_body, line.to_world);
  const Vec2 half = box.box_half_m;
  if (std::min(from.x, to.x) > half.x || std::max(from.x, to.x) < -half.x) return false;
  if (std::min(from.y, to.y) > half.y || std::max(from.y, to.y) < -half.y) return false;
  const Vec2 across = Left(to - from);
  return std::abs(Dot(from, across)) <= half.x * std::abs(across.x) + half.y * std::abs(across.y);
}

}  // namespace

Bounds BoundsOf(const StartShape& shape) {
  const Vec2 at = shape.world_from_body.position_world;
  Vec2 half{shape.radius_m, shape.radius_m};
  if (IsBox(shape)) half = {HalfShadow(shape, {1, 0}), HalfShadow(shape, {0, 1})};
  return {at - half, at + half};
}

Bounds BoundsOf(const StartLine& line) {
  const Vec2 a = line.from_world;
  const Vec2 b = line.to_world;
  return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
}

bool Overlap(const StartShape& a, const StartShape& b) {
  if (!IsFinite(a) || !IsFinite(b)) return false;
  if (IsBox(a) && IsBox(b)) return BoxesOverlap(a, b);
  if (IsBox(a)) return BoxHoldsDisc(a, b);
  if (IsBox(b)) return BoxHoldsDisc(b, a);
  return Norm(a.world_from_body.position_world - b.world_from_body.position_world) <=
         a.radius_m + b.radius_m;
}

bool Overlap(const StartShape& shape, const StartLine& line) {
  const double sum = line.from_world.x + line.from_world.y + line.to_world.x + line.to_world.y;
  if (!IsFinite(shape) || !std::isfinite(sum)) return false;
  if (IsBox(shape)) return BoxMeetsLine(shape, line);
  return DistanceToLine(shape.world_from_body.position_world, line) <= shape.radius_m;
}

bool Cross(const StartLine& a, const StartLine& b) {
  const auto parts = [](const StartLine& line, const StartLine& other) {
    const Vec2 along = line.to_world - line.from_world;
    return Cross(along, other.from_world - line.from_world) *
               Cross(along, other.to_world - line.from_world) <
           0;
  };
  return parts(a, b) && parts(b, a);
}

double DistanceToLine(Vec2 point_world, const StartLine& line) {
  const Vec2 along = line.to_world - line.from_world;
  const double length2 = SquaredNorm(along);
  const double u =
      length2 > 0 ? std::clamp(Dot(point_world - line.from_world, along) / length2, 0.0, 1.0) : 0;
  return Norm(point_world - (line.from_world + u * along));
}

}  // namespace giveway

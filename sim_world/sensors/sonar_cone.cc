#include "sim_world/sensors/sonar_cone.h"

#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"

namespace giveway::sim {
namespace {

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
void Clip(Interval* part, Vec2 normal, Vec2 from, Vec2 along) {
  const double at_from = Dot(normal, from);
  const double change = Dot(normal, along);
  if (change == 0) {
    if (at_from < 0) *part = {2, -1};
  } else if (change > 0) {
    part->low = std::max(part->low, -at_from / change);
  } else {
    part->high = std::min(part->high, -at_from / change);
  }
}

// Whether the line through `from` along `along` is met at `point` within the incidence.
bool Faces(Vec2 from, Vec2 along, Vec2 point, Incidence incidence) {
  const double across = Cross(from, along);
  const double least = incidence.cos_max * incidence.cos_max * SquaredNorm(point);
  return across * across >= least * SquaredNorm(along);
}

}  // namespace

Incidence IncidenceUpTo(double max_rad) {
  if (max_rad >= kPi / 2) return {};
  return {.sin_max = Sin(max_rad), .cos_max = Cos(max_rad)};
}

std::optional<double> RangeToDisc(const Cone& cone, Vec2 centre, double radius_m,
                                  Incidence incidence) {
  Vec2 seen = InCone(cone, centre);
  seen.y = std::abs(seen.y);  // the cone is its own mirror image
  const double squared_distance = SquaredNorm(seen);
  if (squared_distance <= radius_m * radius_m) return 0.0;
  const Vec2 edge = {cone.cos_half, cone.sin_half};
  const double beyond_edge_m = Cross(edge, seen);
  if (beyond_edge_m <= 0) return IfWithin(Sqrt(squared_distance) - radius_m, cone.max_range_m);
  // The disc's distance grows with the angle to its centre: the edge towards it is nearest.
  const double along_edge_m = Dot(edge, seen);
  if (along_edge_m <= 0 || beyond_edge_m > radius_m * incidence.sin_max) return std::nullopt;
  const double half_chord = Sqrt(radius_m * radius_m - beyond_edge_m * beyond_edge_m);
  // Positive but for rounding.
  return IfWithin(std::abs(along_edge_m - half_chord), cone.max_range_m);
}

std::optional<double> RangeToSegment(const Cone& cone, Vec2 from_frame, Vec2 to_frame,
                                     Incidence incidence) {
  const Vec2 from = InCone(cone, from_frame);
  const Vec2 along = InCone(cone, to_frame) - from;
  const double squared_length = SquaredNorm(along);
  const double foot =
      squared_length > 0 ? std::clamp(-Dot(from, along) / squared_length, 0.0, 1.0) : 0.0;
  if (SquaredNorm(from + foot * along) <= kOnTheWall_m * kOnTheWall_m) return 0.0;
  Interval inside;
  Clip(&inside, {cone.sin_half, -cone.cos_half}, from, along);
  Clip(&inside, {cone.sin_half, cone.cos_half}, from, along);
  if (inside.low > inside.high) return std::nullopt;
  // Along the segment the distance grows away from the foot on either side.
  const Vec2 nearest = from + std::clamp(foot, inside.low, inside.high) * along;
  if (!Faces(from, along, nearest, incidence)) return std::nullopt;
  return IfWithin(Norm(nearest), cone.max_range_m);
}

}  // namespace giveway::sim

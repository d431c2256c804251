#include "sim_world/sensors/beam.h"

#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::sim {
namespace {

// At this distance from a segment the beam is a point: it has no width left to clip to.
constexpr double kAtTheApex_m = 1e-9;

std::optional<Vec2> IfWithin(Vec2 point, double range_m) {
  if (SquaredNorm(point) > range_m * range_m) return std::nullopt;
  return point;
}

// Cuts [low, high], the part of from + u * side that is left, down to where normal . point >= 0.
void Clip(Vec2 normal, Vec2 from, Vec2 side, double* low, double* high) {
  const double at_from = Dot(normal, from);
  const double change = Dot(normal, side);
  if (change > 0) *low = std::max(*low, -at_from / change);
  if (change < 0) *high = std::min(*high, -at_from / change);
  if (change == 0 && at_from < 0) *high = -1;
}

}  // namespace

Beam BeamOf(double half_angle_rad, double range_m) {
  return {Cos(half_angle_rad), Sin(half_angle_rad), range_m};
}

bool Holds(const Beam& beam, Vec2 point) {
  // A point found on the beam's edge is in it.
  constexpr double kRounding_m = 1e-9;
  const double beyond_edge_m = beam.cos_half * std::abs(point.y) - beam.sin_half * point.x;
  return beyond_edge_m <= kRounding_m && IfWithin(point, beam.range_m);
}

std::optional<Vec2> NearestOfDisc(const Beam& beam, Vec2 centre, double radius_m) {
  const double squared_distance = SquaredNorm(centre);
  if (squared_distance <= radius_m * radius_m) return Vec2{};
  // The beam is its own mirror image: the edge on the centre's side is the one that counts.
  const double side = centre.y < 0 ? -1 : 1;
  const Vec2 edge = {beam.cos_half, side * beam.sin_half};
  const double beyond_edge_m = side * Cross(edge, centre);
  if (beyond_edge_m <= 0) {
    const double distance = Sqrt(squared_distance);
    return IfWithin((distance - radius_m) / distance * centre, beam.range_m);
  }
  // The centre is outside: of the disc's part inside, the edge's first point is nearest.
  const double along_edge_m = Dot(edge, centre);
  if (along_edge_m <= 0 || beyond_edge_m > radius_m) return std::nullopt;
  const double half_chord_m = Sqrt(radius_m * radius_m - beyond_edge_m * beyond_edge_m);
  return IfWithin((along_edge_m - half_chord_m) * edge, beam.range_m);
}

std::optional<Vec2> NearestOfSegment(const Beam& beam, Vec2 from, Vec2 to) {
  const double foot = NearestParameter(from, to, {});
  const Vec2 side = to - from;
  if (SquaredNorm(from + foot * side) <= kAtTheApex_m * kAtTheApex_m) return Vec2{};
  double low = 0;
  double high = 1;
  Clip({beam.sin_half, -beam.cos_half}, from, side, &low, &high);
  Clip({beam.sin_half, beam.cos_half}, from, side, &low, &high);
  if (low > high) return std::nullopt;
  return IfWithin(from + std::clamp(foot, low, high) * side, beam.range_m);
}

}  // namespace giveway::sim

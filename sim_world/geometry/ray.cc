#include "sim_world/geometry/ray.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway::sim {

std::optional<double> RayToDisc(Vec2 direction, Vec2 centre, double radius_m) {
  const double squared_radius = radius_m * radius_m;
  if (SquaredNorm(centre) <= squared_radius) return 0.0;
  const double along = Dot(direction, centre);
  const double across = Cross(direction, centre);
  const double squared_half_chord = squared_radius - across * across;
  if (along <= 0 || squared_half_chord < 0) return std::nullopt;
  return std::max(0.0, along - Sqrt(squared_half_chord));
}

std::optional<double> RayToSegment(Vec2 direction, Vec2 from, Vec2 to) {
  const Vec2 side = to - from;
  const double slope = Cross(direction, side);
  if (slope == 0) {
    if (Cross(direction, from) != 0) return std::nullopt;
    const double nearer = std::min(Dot(direction, from), Dot(direction, to));
    const double farther = std::max(Dot(direction, from), Dot(direction, to));
    if (farther < 0) return std::nullopt;
    return std::max(0.0, nearer);
  }
  const double parameter = -Cross(direction, from) / slope;
  const double along = Cross(from, side) / slope;
  if (parameter < 0 || parameter > 1 || along < 0) return std::nullopt;
  return along;
}

}  // namespace giveway::sim

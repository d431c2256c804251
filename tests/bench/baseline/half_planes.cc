#include "tests/bench/baseline/half_planes.h"

#include <algorithm>
#include <vector>

#include "services/types/math/math.h"

namespace giveway::bench {
namespace {

struct Stretch {
  double from;
  double to;
};

// Of the plane's edge, as distances from its point: what the top speed leaves.
std::optional<Stretch> EdgeWithinSpeed(const HalfPlane& plane, double top_speed) {
  const double middle = -Dot(plane.point, Left(plane.normal));
  const double off = Dot(plane.point, plane.normal);
  const double half_squared = top_speed * top_speed - off * off;
  if (half_squared < 0) return std::nullopt;
  const double half = Sqrt(half_squared);
  return Stretch{middle - half, middle + half};
}

// Cuts the edge of a plane down to what another allows of it. False if nothing is left.
bool Cut(const HalfPlane& edge, const HalfPlane& by, Stretch* stretch) {
  constexpr double kParallel = 1e-9;
  const double rise = Dot(Left(edge.normal), by.normal);
  const double inside = Inside(by, edge.point);
  if (rise < kParallel && rise > -kParallel) return inside >= 0;
  if (rise > 0) {
    stretch->from = std::max(stretch->from, -inside / rise);
  } else {
    stretch->to = std::min(stretch->to, -inside / rise);
  }
  return stretch->from <= stretch->to;
}

std::optional<Vec2> NearestOnEdge(std::span<const HalfPlane> before, const HalfPlane& edge,
                                  double top_speed, Vec2 wanted) {
  std::optional<Stretch> stretch = EdgeWithinSpeed(edge, top_speed);
  if (!stretch) return std::nullopt;
  for (const HalfPlane& plane : before) {
    if (!Cut(edge, plane, &*stretch)) return std::nullopt;
  }
  const Vec2 along = Left(edge.normal);
  const double nearest = Dot(wanted - edge.point, along);
  return edge.point + std::clamp(nearest, stretch->from, stretch->to) * along;
}

}  // namespace

std::optional<Vec2> NearestAllowed(std::span<const HalfPlane> planes, double top_speed,
                                   Vec2 wanted) {
  const double speed = Norm(wanted);
  Vec2 best = speed > top_speed ? top_speed / speed * wanted : wanted;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (Inside(planes[i], best) >= 0) continue;
    // What is nearest now breaks this plane: what is nearest with it lies on its edge.
    const std::optional<Vec2> on_edge =
        NearestOnEdge(planes.first(i), planes[i], top_speed, wanted);
    if (!on_edge) return std::nullopt;
    best = *on_edge;
  }
  return best;
}

Vec2 NearestTolerable(std::span<const HalfPlane> planes, double top_speed, Vec2 wanted) {
  if (const std::optional<Vec2> allowed = NearestAllowed(planes, top_speed, wanted)) {
    return *allowed;
  }
  double refused = 0;  // planes moved back by this much still leave nothing
  double granted = top_speed;
  for (const HalfPlane& plane : planes) {
    granted = std::max(granted, Dot(plane.point, plane.normal));  // standing still is tolerable
  }
  std::vector<HalfPlane> moved(planes.begin(), planes.end());
  Vec2 best;
  for (int i = 0; i < 30; ++i) {
    const double middle = (refused + granted) / 2;
    for (std::size_t j = 0; j < planes.size(); ++j) {
      moved[j].point = planes[j].point - middle * planes[j].normal;
    }
    const std::optional<Vec2> allowed = NearestAllowed(moved, top_speed, wanted);
    (allowed ? granted : refused) = middle;
    if (allowed) best = *allowed;
  }
  return best;
}

}  // namespace giveway::bench

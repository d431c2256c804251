#include "services/types/math/distance.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr double kInverseSqrt2 = 0.70710678118654752;

}  // namespace

std::string_view Name(DistanceMetric metric) {
  switch (metric) {
    case DistanceMetric::kEuclidean:
      return "euclidean";
    case DistanceMetric::kManhattan:
      return "manhattan";
    case DistanceMetric::kChebyshev:
      return "chebyshev";
  }
  return "unknown";
}

double Distance(DistanceMetric metric, Vec2 offset_world) {
  const double x = Magnitude(offset_world.x);
  const double y = Magnitude(offset_world.y);
  switch (metric) {
    case DistanceMetric::kEuclidean:
      break;
    case DistanceMetric::kManhattan:
      return x + y;
    case DistanceMetric::kChebyshev:
      return std::max(x, y);
  }
  return Norm(offset_world);
}

// The smaller of the two takes care of the last bit, where rounding could go either way.
double GateDistance(DistanceMetric metric, Vec2 offset_world) {
  if (metric == DistanceMetric::kEuclidean) return Norm(offset_world);
  const double scale = metric == DistanceMetric::kManhattan ? kInverseSqrt2 : 1;
  return std::min(scale * Distance(metric, offset_world), Norm(offset_world));
}

}  // namespace giveway

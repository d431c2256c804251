// How far apart two places are, by the metrics the lecture allows. Between the same two places
// Chebyshev <= Euclidean <= Manhattan <= sqrt(2) Euclidean. Knows no bodies and no gates.
#pragma once

#include <cstdint>
#include <string_view>

#include "services/types/math/vec2.h"

namespace giveway {

enum class DistanceMetric : std::uint8_t {
  kEuclidean,  // sqrt(x^2 + y^2), the lecture's own
  kManhattan,  // |x| + |y|
  kChebyshev,  // max(|x|, |y|)
};

std::string_view Name(DistanceMetric metric);

// Length of an offset along the axes of the world, m.
double Distance(DistanceMetric metric, Vec2 offset_world);

// The same for a gate that something near must not slip through: never above the Euclidean
// distance, whatever the metric, so a gate only ever widens. Chebyshev is below it by itself and
// makes the round gate a square; Manhattan is scaled by 1 / sqrt(2) and makes it a diamond. Either
// holds the whole circle and reaches at most sqrt(2) times as far.
double GateDistance(DistanceMetric metric, Vec2 offset_world);

}  // namespace giveway

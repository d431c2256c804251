// The velocity nearest to a wanted one under a few half planes and a top speed: the linear program
// of van den Berg, Guy, Lin and Manocha, "Reciprocal n-body Collision Avoidance" (ISRR 2009),
// solved plane by plane. Knows nothing of vehicles.
#pragma once

#include <optional>
#include <span>

#include "services/types/math/vec2.h"

namespace giveway::bench {

// Allowed is what lies beyond the point in the direction of the normal.
struct HalfPlane {
  Vec2 point;
  Vec2 normal;  // of length 1
};

// How far inside its allowed side; negative: outside.
inline double Inside(const HalfPlane& plane, Vec2 velocity) {
  return Dot(velocity - plane.point, plane.normal);
}

// None if nothing within the top speed is allowed by all.
std::optional<Vec2> NearestAllowed(std::span<const HalfPlane> planes, double top_speed,
                                   Vec2 wanted);

// The same; where nothing is allowed by all, what breaks the worst broken one the least.
Vec2 NearestTolerable(std::span<const HalfPlane> planes, double top_speed, Vec2 wanted);

}  // namespace giveway::bench

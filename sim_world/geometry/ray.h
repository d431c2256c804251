// Where a ray from the origin first meets a shape, in closed form. `direction` is a unit vector;
// distances are along it, 0 where the origin is in or on the shape.
#pragma once

#include <optional>

#include "services/types/math/vec2.h"

namespace giveway::sim {

std::optional<double> RayToDisc(Vec2 direction, Vec2 centre, double radius_m);
// A segment along the ray is met at its nearer end.
std::optional<double> RayToSegment(Vec2 direction, Vec2 from, Vec2 to);

}  // namespace giveway::sim

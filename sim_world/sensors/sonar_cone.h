// What one ultrasonic transducer hears of one disc or wall, in closed form: the exact distance to
// the nearest point inside its cone, if the surface there faces the transducer well enough. This is
// the readable reference; sonar_kernel.h does the same for many at once and must agree to the bit.
#pragma once

#include <optional>

#include "services/types/math/vec2.h"

namespace giveway::sim {

// What a transducer can hear: all points within max_range_m of the apex and within the half angle
// of the axis. Apex, axis and the objects share one frame; the half angle is below a right angle.
struct Cone {
  Vec2 apex;
  Vec2 axis;  // unit vector
  double cos_half = 1;
  double sin_half = 0;
  double max_range_m = 0;
};

// How far off a surface's normal it still answers. The ideal surface answers at any angle.
struct Incidence {
  double sin_max = 1;
  double cos_max = 0;
};
Incidence IncidenceUpTo(double max_rad);

// An apex this near to a wall stands on it: there the cone has no width left to clip a wall to.
inline constexpr double kOnTheWall_m = 1e-9;

// Distance from the apex to the nearest point in the cone; none if the object is outside it or
// turned too far away there, 0 if the apex is in or on the object. A wall has two ends and no
// thickness: at an end it answers no better than its face would.
std::optional<double> RangeToDisc(const Cone& cone, Vec2 centre, double radius_m,
                                  Incidence incidence = {});
std::optional<double> RangeToSegment(const Cone& cone, Vec2 from, Vec2 to,
                                     Incidence incidence = {});

}  // namespace giveway::sim

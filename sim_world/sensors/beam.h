// The nearest point of a shape in a radar beam: a sector about the x axis with its apex at the
// origin. As the ultrasonics' cone, but it says where, not only how far.
#pragma once

#include <optional>

#include "services/types/math/vec2.h"

namespace giveway::sim {

struct Beam {
  double cos_half = 1;  // of half the opening, which is below a right angle
  double sin_half = 0;
  double range_m = 0;
};
Beam BeamOf(double half_angle_rad, double range_m);

bool Holds(const Beam& beam, Vec2 point);

// Empty if no part of the shape is in the beam; the origin if that is in or on the shape.
std::optional<Vec2> NearestOfDisc(const Beam& beam, Vec2 centre, double radius_m);
std::optional<Vec2> NearestOfSegment(const Beam& beam, Vec2 from, Vec2 to);

}  // namespace giveway::sim

// What two motions do to the gap between shells: when it closes (contact) and how small it gets
// (closest approach). Discs have exact paths of their own; boxes, which turn within a tick, and
// sliding leaves go through outlines (outline_motion.h).
#pragma once

#include <optional>

#include "services/types/scenario.h"
#include "sim_world/geometry/motion.h"
#include "sim_world/geometry/outline_motion.h"

namespace giveway::sim {

// First time in [from_s, to_s] at which the shells touch and still close in; none if they never do.
// Neither may change from moving to standing within the interval.
std::optional<double> FirstContact(const Motion& a, const Motion& b, double from_s, double to_s);
std::optional<double> FirstContact(const Motion& body, const Leaf& leaf, double from_s,
                                   double to_s);
std::optional<double> FirstContact(const Motion& body, const Wall& wall, double from_s,
                                   double to_s);

// The smallest gap in [0, to_s], stops included. With a box: to within kTouch_m. Between discs:
// exact to 1e-9 m where the gap has one minimum between stops; arcs that bend within a tick may
// hide a second one, at most |v w| to_s^2 / 8 a body deeper (0.6 mm at full speed and full turn at
// 20 Hz).
ClosestMoment ClosestWithin(const Motion& a, const Motion& b, double to_s);

}  // namespace giveway::sim

// A body's motion within one tick, and what two motions do to the gap between shells: when it
// closes (contact) and how small it gets (closest approach). Bodies are discs round the axle
// centre, so only the centres' paths matter.
#pragma once

#include <optional>

#include "services/types/pose.h"
#include "services/types/scenario.h"

namespace giveway::sim {

// Shells this near are touching. Contact times are found to within it.
inline constexpr double kTouch_m = 1e-6;

// Along the arc of `twist` from `start`, standing from stop_s on. Times are seconds in the tick.
struct Motion {
  Pose start_world;
  Twist twist;
  double stop_s = 0;
  double radius_m = 0;  // of the body's disc
};

Vec2 PositionAt(const Motion& motion, double t_s);

// First time in [from_s, to_s] at which the shells touch and still close in; none if they never do.
// Neither body may change from moving to standing within the interval.
std::optional<double> FirstContact(const Motion& a, const Motion& b, double from_s, double to_s);
std::optional<double> FirstContact(const Motion& body, const Wall& wall, double from_s,
                                   double to_s);

struct ClosestMoment {
  double gap_m = 0;  // shell to shell
  double t_s = 0;
};

// The smallest gap in [0, to_s], stops included. Exact to 1e-9 m where the gap has one minimum
// between stops; arcs that bend within a tick may hide a second one, at most
// |v w| to_s^2 / 8 a body deeper (0.6 mm at full speed and full turn at 20 Hz).
ClosestMoment ClosestWithin(const Motion& a, const Motion& b, double to_s);

}  // namespace giveway::sim

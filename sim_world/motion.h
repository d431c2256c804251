// A motion within one tick, and what two motions do to the gap between shells: when it closes
// (contact) and how small it gets (closest approach). Discs have exact paths of their own; boxes,
// which turn within a tick, and sliding leaves go through outlines.
#pragma once

#include <optional>

#include "services/types/pose.h"
#include "services/types/scenario.h"
#include "sim_world/outline.h"

namespace giveway::sim {

// Shells this near are touching. Contact times are found to within it.
inline constexpr double kTouch_m = 1e-6;

// Along the arc of `twist` from `start`, or straight along `slide` without turning; standing from
// stop_s on. Times are seconds in the tick.
struct Motion {
  Pose start_world;
  Twist twist;
  double stop_s = 0;
  double radius_m = 0;  // of a disc, or of the disc round a box
  Vec2 box_half_m;      // half length and half width of a box; {0, 0}: a disc
  Vec2 slide_world;     // m/s; where it is not zero, the twist is

  bool IsBox() const { return box_half_m.x > 0; }
};

// A straight leaf without thickness, one end of which may slide. A wall is a leaf that stands.
struct Leaf {
  Vec2 from_world;
  Vec2 to_world;           // at the start of the tick
  Vec2 to_velocity_world;  // m/s, along the leaf
  double stop_s = 0;
};

// A vehicle's body that stands.
Motion StandingAt(const VehicleProfile& profile, const Pose& world_from_body);

Pose PoseAt(const Motion& motion, double t_s);
Vec2 PositionAt(const Motion& motion, double t_s);
Vec2 TipAt(const Leaf& leaf, double t_s);
// With the velocities that hold at t_s, before a stop there.
Outline OutlineAt(const Motion& motion, double t_s);
Outline OutlineAt(const Leaf& leaf, double t_s);
Outline OutlineOf(const Wall& wall);

bool Moves(const Motion& motion);
bool Moves(const Leaf& leaf);
// How far the centre (the tip) can get in dt_s, m.
double TravelBound(const Motion& motion, double dt_s);
double TravelBound(const Leaf& leaf, double dt_s);

// Shell to shell at t_s; negative where they overlap.
double GapAt(const Motion& a, const Motion& b, double t_s);
double GapAt(const Motion& a, const Leaf& leaf, double t_s);
double GapAt(const Motion& a, const Wall& wall, double t_s);

// First time in [from_s, to_s] at which the shells touch and still close in; none if they never do.
// Neither may change from moving to standing within the interval.
std::optional<double> FirstContact(const Motion& a, const Motion& b, double from_s, double to_s);
std::optional<double> FirstContact(const Motion& body, const Leaf& leaf, double from_s,
                                   double to_s);
std::optional<double> FirstContact(const Motion& body, const Wall& wall, double from_s,
                                   double to_s);

struct ClosestMoment {
  double gap_m = 0;  // shell to shell
  double t_s = 0;
};

// The smallest gap in [0, to_s], stops included. With a box: to within kTouch_m. Between discs:
// exact to 1e-9 m where the gap has one minimum between stops; arcs that bend within a tick may
// hide a second one, at most |v w| to_s^2 / 8 a body deeper (0.6 mm at full speed and full turn at
// 20 Hz).
ClosestMoment ClosestWithin(const Motion& a, const Motion& b, double to_s);

}  // namespace giveway::sim

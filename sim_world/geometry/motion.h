// A motion within one tick: where a body or a leaf is at a moment of it, and how far its shell is
// from another's.
#pragma once

#include "services/types/math/pose.h"
#include "services/types/scenario.h"
#include "sim_world/geometry/outline.h"

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

inline bool BothAreDiscs(const Motion& a, const Motion& b) { return !a.IsBox() && !b.IsBox(); }

// A straight leaf without thickness, one end of which may slide. A wall is a leaf that stands.
struct Leaf {
  Vec2 from_world;
  Vec2 to_world;           // at the start of the tick
  Vec2 to_velocity_world;  // m/s, along the leaf
  double stop_s = 0;
};

// A vehicle's body that stands.
Motion StandingAt(const RobotModel& profile, const Pose& world_from_body);

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

}  // namespace giveway::sim

// Where two paths conflict. Pure geometry in the world frame: every body is a disc, every path the
// half-line it would sweep by going straight on.
#pragma once

#include <cstdint>
#include <optional>

#include "services/types/math/vec2.h"

namespace giveway {

// Further than any path of this world leads: stands for never, and for ever.
inline constexpr double kFar_m = 1e6;

// A stretch of a path, metres from its start. Negative lies behind the start. An empty one starts
// at infinity and ends at minus infinity: also one that lies behind ends no later than at 0.
struct Stretch {
  double begin_m = 0;
  double end_m = 0;
};

// A path: from a point onwards along a unit vector.
struct Path {
  Vec2 from_world;
  Vec2 direction_world;
};

// The stretch of the whole line through `path` that lies within `reach_m` of the half-line `other`.
// The set of points near a half-line is convex, so it is one stretch or none.
Stretch StretchNear(const Path& path, const Path& other, double reach_m);

// The same of the first length_m of `other`.
Stretch StretchNearSegment(const Path& path, const Path& other, double length_m, double reach_m);

// Both paths' stretches in conflict: where one body on its path can touch the other on its own.
struct Conflict {
  Stretch own;
  Stretch peer;
  bool across = false;    // at more than 30 degrees, not along each other or against
  bool one_lane = false;  // from end to end of a one-lane section: one_lane.h
  std::uint8_t lane = 0;  // which of those ahead (OwnCourse::lanes), where it is one
};

// Empty if the paths never come within `reach_m`, or either vehicle has its stretch behind it.
std::optional<Conflict> FindConflict(const Path& own, const Path& peer, double reach_m);

// Distance needed to stand still: v * reaction + v^2 / (2 * deceleration). All SI, v >= 0.
constexpr double StoppingDistance(double speed_m_s, double reaction_s, double deceleration_m_s2) {
  return speed_m_s * reaction_s + speed_m_s * speed_m_s / (2 * deceleration_m_s2);
}

// The highest speed from which one stands still within `distance_m`; 0 if that is not positive.
double SpeedToStopWithin(double distance_m, double reaction_s, double deceleration_m_s2);

// Seconds to cover `distance_m` starting at `speed_m_s` and accelerating up to `cruise_m_s`.
double TimeToCover(double distance_m, double speed_m_s, double cruise_m_s,
                   double acceleration_m_s2);

}  // namespace giveway

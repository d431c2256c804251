// One-lane sections of the map that a fleet shares, in which no two vehicles pass each other: a
// passage one body wide, a narrow door, a ramp. Who comes towards one that is in it waits outside.
#pragma once

#include <cstddef>

#include "services/types/math/vec2.h"

namespace giveway {

// All points within half of width_m of the line between both ends. The ends lie so far outside the
// narrow part that one that leaves gets past one that waits there.
struct OneLane {
  Vec2 from_world;  // m
  Vec2 to_world;    // m; apart from from_world
  double width_m = 0;
};

inline constexpr std::size_t kMaxOneLanes = 64;
// Between the section and the shell of a vehicle that waits outside it.
inline constexpr double kOneLaneMargin_m = 0.1;
// After so long a vehicle has surely heard that another one is in: several beacons, of which some
// may be lost.
inline constexpr double kOneLaneHeard_s = 0.5;

}  // namespace giveway

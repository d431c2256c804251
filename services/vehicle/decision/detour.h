// The way round a crowd: a shortest path on a small map of what stands, for a vehicle that steering
// alone has left going to and fro in front of it. Pure; its memory is on the stack.
#pragma once

#include <optional>
#include <span>

#include "services/types/math/vec2.h"

namespace giveway {

// A place the own axle centre keeps out of: a disc, metres, world frame.
struct KeepOut {
  Vec2 centre_world;
  double radius_m = 0;
};

// The farthest point in sight, along a shortest way from `from_world` towards `to_world` past all
// of `discs`, or as near to it as one gets; empty if that is where the vehicle is. Looks 5 m in
// every direction, in steps of 0.25 m; a way may scrape through the edge of a disc that the vehicle
// already stands in.
std::optional<Vec2> FirstTurn(Vec2 from_world, Vec2 to_world, std::span<const KeepOut> discs);

}  // namespace giveway

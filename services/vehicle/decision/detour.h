// The detour round a crowd: a shortest path on a small map of standing bodies, for a vehicle that
// steering alone left moving to and fro in front of it. Pure; its memory is on the stack.
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

// The furthest visible point of a shortest path from `from_world` to `to_world` that avoids all of
// `discs`, or gets as near to it as possible; empty if that is where the vehicle is. Searches 5 m
// in each direction, in steps of 0.25 m; a path may cross the edge of a disc that the vehicle is
// already inside.
std::optional<Vec2> FirstTurn(Vec2 from_world, Vec2 to_world, std::span<const KeepOut> discs);

}  // namespace giveway

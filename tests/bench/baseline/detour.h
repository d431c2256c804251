// The path of a string pulled tight round discs in between: straight pieces that touch the discs,
// and arcs along their rims.
#pragma once

#include <optional>
#include <span>

#include "tests/bench/baseline/arc_path.h"

namespace giveway::bench {

struct Standing {
  Vec2 centre_world;
  double radius_m = 0;  // the path stays outside it
};

// From one place to another and straight on for beyond_m; it starts heading where it goes. Not
// always the shortest. None if discs overlap so that none was found.
std::optional<ArcPath> PathAround(Vec2 from_world, Vec2 to_world, std::span<const Standing> discs,
                                  double beyond_m);

}  // namespace giveway::bench

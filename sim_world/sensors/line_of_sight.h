// Whether anything stands on the line between two points of a scene.
#pragma once

#include "sim_world/sensors/scene.h"

namespace giveway::sim {

// Whether a shape of neither owner stands on the line between the two points. A wall met edge-on
// hides nothing.
bool IsBlocked(const Scene& scene, Vec2 from_world, Vec2 to_world, Owner from, Owner to);

}  // namespace giveway::sim

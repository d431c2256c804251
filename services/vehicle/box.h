// Keeps crossings clear: conflicts that follow each other without room to stand between them are
// one box, and a vehicle that must hold for a peer in it holds before the whole of it. Whoever
// stopped inside would stand in somebody else's way, and a few of those make a ring that nobody
// leaves.
#pragma once

#include <span>

#include "services/vehicle/situation.h"

namespace giveway {

// Sets `box_begin_m` of every view that crosses the own way.
void FindBoxes(std::span<PeerView> views, const Situation& s);

}  // namespace giveway

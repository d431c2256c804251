// Keeps crossings clear: conflicts that follow each other without room to stand between them are
// one box. A vehicle that must hold for a peer in it holds before the whole of it, and it does not
// drive into one that it cannot leave, because somebody stands, or will stand, where it would come
// out. Whoever stopped inside would be in somebody else's way, and a few of those make a ring that
// nobody leaves.
#pragma once

#include <optional>
#include <span>

#include "services/vehicle/situation/situation.h"

namespace giveway {

// Sets `box_begin_m` of every view that crosses the own way. The nearest box ahead that the vehicle
// would come to stand in, as things are now.
std::optional<BlockedBox> FindBoxes(std::span<PeerView> views, const OwnView& s);

}  // namespace giveway

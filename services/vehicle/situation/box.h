// Keeps crossings clear: conflicts that follow each other without enough space to stand between
// them are one box. A vehicle that must hold for a peer in a box holds before all of it, and it
// does not enter a box that it cannot leave because a vehicle stands, or will stand, at the exit. A
// vehicle stopped inside would block another, and a few of those make a ring: a deadlock.
#pragma once

#include <optional>
#include <span>

#include "services/vehicle/situation/situation.h"

namespace giveway {

struct Boxes {
  std::span<PeerView> views;          // whole now
  std::optional<BlockedBox> blocked;  // the nearest ahead that the vehicle would come to stand in
};

// Completes the views: where the box starts, for each peer that crosses the own path. `blocked` is
// the box that cannot be left as things are now.
Boxes FindBoxes(PeerViews<RelatedPeer> views, const OwnView& s);

}  // namespace giveway

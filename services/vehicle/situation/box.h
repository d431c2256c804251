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

struct Boxes {
  std::span<PeerView> views;          // whole now
  std::optional<BlockedBox> blocked;  // the nearest ahead that the vehicle would come to stand in
};

// Makes the views whole: where the box begins, of each that crosses the own way. Blocked is a box
// as things are now.
Boxes FindBoxes(PeerViews<RelatedPeer> views, const OwnView& s);

}  // namespace giveway

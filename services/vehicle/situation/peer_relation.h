// Relates each peer to this vehicle: where it is by now, where its path crosses the own one, how
// far its claim leaves the own path free, which has priority, whether it grants this vehicle
// passage. Every view stands on its beacon and the own state alone; what follows from all of them
// together is found in box.h and encounter.h.
#pragma once

#include "services/vehicle/situation/situation.h"

namespace giveway {

// The radius, from the centre of a vehicle of that profile to another one's shell, within which it
// computes more of a peer than its claim.
double InterestRadius(const RobotModel& profile);

// False if the peer and all of its path are so far away that no rule can depend on it. It costs a
// fraction of RelatePeers, and most of a large fleet is far away.
bool IsRelevant(const Peer& peer, bool fresh, const OwnView& s);

// Carries the peers of all views forward to now and measures how they lie to the own vehicle. For
// all before RelatePeers at any: a sine or a root is a chain of operations of which each waits for
// the one before, and those of several peers run side by side.
PeerViews<CarriedPeer> CarryForward(PeerViews<HeardPeer> views, const OwnView& s);

// How far this vehicle may go along a unit vector until its shell is at the peer's claim, metres;
// huge if it never is, or so far on that the own cruise speed is not too fast for it.
double FreeAlong(const CarriedPeer& view, Vec2 forward_world, const OwnView& s);

// What RelatePeers makes of the views, and what it found of all of them.
struct RelatedPeers {
  PeerViews<RelatedPeer> views;
  std::uint32_t explained = 0;  // see PeersNow
  bool someone_doubted = false;
};

// Relates the peers of all views to the own path.
RelatedPeers RelatePeers(PeerViews<CarriedPeer> views, const OwnView& s);

}  // namespace giveway

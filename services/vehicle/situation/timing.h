// Which vehicle clears a conflict first, as far as speeds and accelerations say. Estimates for the
// right of way alone: where they are wrong, the claims (claim.h) still keep the bodies apart.
#pragma once

#include "services/vehicle/situation/situation.h"

namespace giveway {

// How long this vehicle takes to drive so far, s; 0 for what lies behind.
double SecondsTo(double distance_m, const OwnView& s);

// How fast the peer may drive soon: above its cruise speed by kCruiseSlack.
double FastestOf(const CarriedPeer& view);

// True if, by every path of the peer at up to a tenth above its cruise speed, this vehicle leaves
// the conflict before the peer can reach it.
bool IsThroughFirst(const RelatedPeer& view, const OwnView& s);

// True if the peer moves and, driving on as it does, is out of the conflict before this vehicle can
// reach it.
bool IsGoneInTime(const RelatedPeer& view, const OwnView& s);

}  // namespace giveway

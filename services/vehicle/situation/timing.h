// Who is through a conflict before whom, as far as speeds and accelerations tell. Estimates for the
// right of way alone: where they are wrong, the claims (claim.h) still keep the bodies apart.
#pragma once

#include "services/vehicle/situation/situation.h"

namespace giveway {

// True if every way of the peer at up to a tenth above its cruise speed leaves this vehicle out of
// the conflict before the peer can reach it.
bool IsThroughFirst(const RelatedPeer& view, const OwnView& s);

// True if the peer moves and, driving on as it does, is out of the conflict before this vehicle can
// reach it.
bool IsGoneInTime(const RelatedPeer& view, const OwnView& s);

}  // namespace giveway

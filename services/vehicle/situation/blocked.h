// Whose body is in whose way, and what follows for the order: whoever blocks one that comes earlier
// acts by that one's key, or the earlier one would wait for all that the blocker waits for. Says
// nothing about conflicts of ways that are free.
#pragma once

#include "services/types/decision.h"
#include "services/vehicle/estimation/peer_table.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// The own key, or that of the first in the order that says it is blocked by this vehicle.
OrderKey ActingOrder(const OrderKey& own, const PeerTable& peers, VehicleId own_id);

// Who is bodily in the way: stands where this vehicle wants to be, leads in its lane more slowly,
// keeps it from driving by `decision`, or is `not_passed`, which it fails to steer round. kNobody
// if nobody is.
VehicleId BlockedBy(const Situation& s, const Decision& decision, VehicleId not_passed);

// True if that peer is fresh and near enough to be in the way again at once.
bool IsStillNear(VehicleId peer, const Situation& s);

// True if `blocker`, or whoever is in its way, and so on along the queue, is `vehicle`.
bool IsBehind(VehicleId blocker, VehicleId vehicle, std::span<const PeerView> views);

}  // namespace giveway

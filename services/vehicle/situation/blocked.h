// Which vehicle blocks which, and priority inheritance: a vehicle that blocks one with a higher
// priority acts by that one's key, or the blocked one would wait for everything the blocker waits
// for. Says nothing about conflicts of paths that are free.
#pragma once

#include <span>

#include "services/types/decision.h"
#include "services/vehicle/estimation/peer_table.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// Nearer than this, the one ahead in the lane holds up.
inline constexpr double kQueueWithin_m = 1.5;

// The own key, or that of the first in the order that says it is blocked by this vehicle. Not of
// one that is doubted, nor of one that has been silent for longer than what it claims lasts.
PriorityKey ActingOrder(const PriorityKey& own, const PeerTable& peers, const Moment& moment,
                        const VehicleOptions& options);

// The peer whose body blocks this vehicle: it stands where this vehicle wants to be, leads in its
// lane more slowly, keeps it from driving by `decision`, or is `not_passed`, which it fails to
// steer round. kNoVehicle if there is none.
VehicleId BlockedBy(const Situation& s, const Decision& decision, VehicleId not_passed);

// That vehicle among the relevant peers; null if it is none.
const PeerView* ViewOf(VehicleId vehicle, std::span<const PeerView> views);

// The nearest of those that `applies` is true of; null if there is none.
template <typename Predicate>
const PeerView* NearestOf(std::span<const PeerView> views, Predicate applies) {
  const PeerView* nearest = nullptr;
  for (const PeerView& view : views) {
    if (!applies(view)) continue;
    if (nearest == nullptr || view.gap_m < nearest->gap_m) nearest = &view;
  }
  return nearest;
}

// True if `blocker`, or the vehicle that blocks it, and so on along the queue, is `vehicle`.
bool IsBehind(VehicleId blocker, VehicleId vehicle, std::span<const PeerView> views);

}  // namespace giveway

#include "services/vehicle/situation/blocked.h"

#include <algorithm>

#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/estimation/trust.h"
#include "services/vehicle/situation/claim.h"

namespace giveway {
namespace {

constexpr double kOccupiedWithin_m = 2;  // nearer than this, what stands on the goal blocks

// The nearest of those that halt for this vehicle.
VehicleId NearestThatWaits(const Situation& s) {
  const PeerView* nearest = NearestOf(s.near.peers, [&s](const PeerView& view) {
    return view.fresh && view.standing && view.peer->beacon.gives_way_to == s.own.options.id;
  });
  return nearest == nullptr ? kNoVehicle : nearest->peer->id;
}

// Whether what it says of being blocked still holds.
bool Lends(const Peer& peer, const Moment& moment, const VehicleOptions& options) {
  return !peer.rivalled && !IsDoubted(peer.trust, moment.now) &&
         Age(peer, moment.now, moment.tick, options.tick_period) <= ClaimLasts(options);
}

// The vehicle that `vehicle` reports as blocking it; kNoVehicle if that is not among the relevant
// peers.
VehicleId WhoBlocks(VehicleId vehicle, std::span<const PeerView> views) {
  const PeerView* view = ViewOf(vehicle, views);
  return view != nullptr && view->fresh ? view->peer->beacon.blocked_by : kNoVehicle;
}

}  // namespace

PriorityKey ActingOrder(const PriorityKey& own, const PeerTable& peers, const Moment& moment,
                        const VehicleOptions& options) {
  PriorityKey acting = own;
  if (MutantActive(Mutant::kLendingDropped)) return acting;
  for (const Peer& peer : peers.Peers()) {
    const bool blocked = peer.known && peer.beacon.blocked_by == options.id && !IsGone(peer);
    if (!blocked || !PrecedesByKey(peer.beacon.order, acting)) continue;
    if (Lends(peer, moment, options)) acting = peer.beacon.order;
  }
  return acting;
}

VehicleId BlockedBy(const Situation& s, const Decision& decision, VehicleId not_passed) {
  if (s.own.arrived || s.own.lost) return kNoVehicle;
  for (const PeerView& view : s.near.peers) {
    const bool there = view.fresh && (view.standing || view.gap_m < kOccupiedWithin_m);
    if (there && Occupies(view, Toward(s.own), s.own)) return view.peer->id;
  }
  // In the own lane, and what keeps this vehicle below its cruise speed.
  const auto leader = std::ranges::find_if(s.near.peers, [&s](const PeerView& view) {
    return view.leads && view.fresh && view.gap_m < kQueueWithin_m &&
           view.speed_m_s < s.own.options.cruise_m_s;
  });
  if (leader != s.near.peers.end()) return leader->peer->id;
  const bool stands = s.own.speed_m_s < kStandingSpeed_m_s;
  if (decision.rule == Rule::kKeepClear && stands) return decision.peer;
  if (!s.escape.no_progress) return kNoVehicle;
  // A vehicle that finds no path through those waiting for it lets one of them go.
  const VehicleId waiting = s.escape.long_no_progress ? NearestThatWaits(s) : kNoVehicle;
  return waiting != kNoVehicle ? waiting : not_passed;
}

const PeerView* ViewOf(VehicleId vehicle, std::span<const PeerView> views) {
  const auto found = std::ranges::find_if(
      views, [vehicle](const PeerView& view) { return view.peer->id == vehicle; });
  return found == views.end() ? nullptr : &*found;
}

bool IsBehind(VehicleId blocker, VehicleId vehicle, std::span<const PeerView> views) {
  constexpr int kLongestQueue = 8;  // followed no further: it may close to a ring
  for (int i = 0; i < kLongestQueue && blocker != kNoVehicle; ++i) {
    if (blocker == vehicle) return true;
    blocker = WhoBlocks(blocker, views);
  }
  return false;
}

}  // namespace giveway

#include "services/vehicle/situation/blocked.h"

#include <algorithm>

#include "services/vehicle/estimation/injected_mutants.h"

namespace giveway {
namespace {

constexpr double kQueueWithin_m = 1.5;   // nearer than this, the one ahead in the lane holds up
constexpr double kOccupiedWithin_m = 2;  // nearer than this, what stands on the goal blocks

// True if the peer leads in the own lane and is what keeps this vehicle below its cruise speed.
bool SlowsDown(const PeerView& view, const OwnView& s) {
  return view.leads && view.fresh && view.gap_m < kQueueWithin_m &&
         view.speed_m_s < s.options.cruise_m_s;
}

// The nearest of those that halt for this vehicle.
VehicleId NearestThatWaits(const Situation& s) {
  const PeerView* nearest = nullptr;
  for (const PeerView& view : s.near.peers) {
    const bool waits =
        view.fresh && view.standing && view.peer->beacon.gives_way_to == s.own.options.id;
    if (waits && (nearest == nullptr || view.gap_m < nearest->gap_m)) nearest = &view;
  }
  return nearest == nullptr ? kNoVehicle : nearest->peer->id;
}

// The vehicle that `vehicle` reports as blocking it; kNoVehicle if that is not among the relevant
// peers.
VehicleId WhoBlocks(VehicleId vehicle, std::span<const PeerView> views) {
  for (const PeerView& view : views) {
    if (view.peer->id == vehicle) return view.fresh ? view.peer->beacon.blocked_by : kNoVehicle;
  }
  return kNoVehicle;
}

}  // namespace

PriorityKey ActingOrder(const PriorityKey& own, const PeerTable& peers, VehicleId own_id) {
  PriorityKey acting = own;
  if (MutantActive(Mutant::kLendingDropped)) return acting;
  for (const Peer& peer : peers.Peers()) {
    const bool blocked = peer.known && peer.beacon.blocked_by == own_id && !IsGone(peer);
    if (blocked && PrecedesByKey(peer.beacon.order, acting)) acting = peer.beacon.order;
  }
  return acting;
}

VehicleId BlockedBy(const Situation& s, const Decision& decision, VehicleId not_passed) {
  if (s.own.arrived || s.own.lost) return kNoVehicle;
  for (const PeerView& view : s.near.peers) {
    const bool there = view.fresh && (view.standing || view.gap_m < kOccupiedWithin_m);
    if (there && Occupies(view, Toward(s.own), s.own)) return view.peer->id;
  }
  const auto leader = std::ranges::find_if(
      s.near.peers, [&s](const PeerView& view) { return SlowsDown(view, s.own); });
  if (leader != s.near.peers.end()) return leader->peer->id;
  const bool stands = s.own.speed_m_s < kStandingSpeed_m_s;
  if (decision.rule == Rule::kKeepClear && stands) return decision.peer;
  if (!s.escape.no_progress) return kNoVehicle;
  // A vehicle that finds no path through those waiting for it lets one of them go.
  const VehicleId waiting = s.escape.long_no_progress ? NearestThatWaits(s) : kNoVehicle;
  return waiting != kNoVehicle ? waiting : not_passed;
}

bool IsHeldByOwnKey(VehicleId peer, const Situation& s) {
  return std::ranges::any_of(s.near.peers, [&](const PeerView& view) {
    return view.peer->id == peer && view.fresh && view.peer->encounter.holds &&
           view.peer->beacon.order.vehicle == s.own.options.id;
  });
}

bool IsStillNear(VehicleId peer, const Situation& s) {
  return std::ranges::any_of(s.near.peers, [peer](const PeerView& view) {
    return view.peer->id == peer && view.fresh && view.gap_m < kQueueWithin_m;
  });
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

#include "services/vehicle_node/beacon_freshness.h"

#include <algorithm>
#include <string_view>

namespace giveway {
namespace {

std::string_view Name(FreshnessKind kind) {
  switch (kind) {
    case FreshnessKind::kHeard:
      return "beacon_heard";
    case FreshnessKind::kStale:
      return "beacon_stale";
    case FreshnessKind::kLeft:
      return "beacon_left";
    case FreshnessKind::kOutOfReach:
      return "beacon_out_of_reach";
  }
  return "unknown";
}

FreshnessKind WhyNotHeard(std::span<const Peer> peers, VehicleId vehicle) {
  const auto peer = std::ranges::lower_bound(peers, vehicle, {}, &Peer::id);
  const bool known = peer != peers.end() && peer->id == vehicle;
  if (known && peer->left) return FreshnessKind::kLeft;
  return known && peer->out_of_reach ? FreshnessKind::kOutOfReach : FreshnessKind::kStale;
}

}  // namespace

std::string Describe(const FreshnessChange& item) {
  return std::string(Name(item.kind)) + ": vehicle " + std::to_string(Number(item.vehicle));
}

void BeaconFreshnessMonitor::Update(std::span<const Peer> peers, SteadyTime now, Tick tick,
                                    const VehicleOptions& options) {
  items_.clear();
  heard_before_.swap(heard_);
  heard_.clear();
  for (const Peer& peer : peers) {
    const bool heard = peer.known && !peer.left && !peer.out_of_reach &&
                       Age(peer, now, tick, options.tick_period) <= options.beacon_age_limit;
    if (!heard) continue;
    heard_.push_back(peer.id);
    if (!std::ranges::binary_search(heard_before_, peer.id)) {
      items_.push_back({FreshnessKind::kHeard, peer.id});
    }
  }
  for (const VehicleId vehicle : heard_before_) {
    if (std::ranges::binary_search(heard_, vehicle)) continue;
    items_.push_back({WhyNotHeard(peers, vehicle), vehicle});
  }
}

}  // namespace giveway

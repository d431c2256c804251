#include "services/vehicle_node/beacon_news.h"

#include <algorithm>
#include <string_view>

namespace giveway {
namespace {

std::string_view Name(BeaconNewsKind kind) {
  switch (kind) {
    case BeaconNewsKind::kHeard:
      return "beacon_heard";
    case BeaconNewsKind::kStale:
      return "beacon_stale";
    case BeaconNewsKind::kLeft:
      return "beacon_left";
    case BeaconNewsKind::kOutOfReach:
      return "beacon_out_of_reach";
  }
  return "unknown";
}

BeaconNewsKind WhyNotHeard(std::span<const Peer> peers, VehicleId vehicle) {
  const auto peer = std::ranges::lower_bound(peers, vehicle, {}, &Peer::id);
  const bool known = peer != peers.end() && peer->id == vehicle;
  if (known && peer->left) return BeaconNewsKind::kLeft;
  return known && peer->out_of_reach ? BeaconNewsKind::kOutOfReach : BeaconNewsKind::kStale;
}

}  // namespace

std::string Describe(const BeaconNewsItem& item) {
  return std::string(Name(item.kind)) + ": vehicle " + std::to_string(Number(item.vehicle));
}

void BeaconNews::Look(std::span<const Peer> peers, SteadyTime now, Tick tick,
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
      items_.push_back({BeaconNewsKind::kHeard, peer.id});
    }
  }
  for (const VehicleId vehicle : heard_before_) {
    if (std::ranges::binary_search(heard_, vehicle)) continue;
    items_.push_back({WhyNotHeard(peers, vehicle), vehicle});
  }
}

}  // namespace giveway

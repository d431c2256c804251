// Whether each peer's beacons are fresh enough to decide by: reported once when it changes, so that
// the log says when a peer became stale. Pure; watches the peer table, changes nothing.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/vehicle/estimation/peer_table.h"

namespace giveway {

enum class FreshnessKind : std::uint8_t {
  kHeard,       // its newest beacon is within the age limit, as none was before
  kStale,       // its newest beacon is older than the age limit
  kLeft,        // it sent a leave notice
  kOutOfReach,  // it speaks from beyond the emission radius
};

struct FreshnessChange {
  FreshnessKind kind = FreshnessKind::kHeard;
  VehicleId vehicle = kNoVehicle;

  friend constexpr bool operator==(const FreshnessChange&, const FreshnessChange&) = default;
};

// "beacon_stale: vehicle 2".
std::string Describe(const FreshnessChange& item);

class BeaconFreshnessMonitor {
 public:
  // `peers` are in the order of their ids; `now` and `tick` those of the step just made.
  void Update(std::span<const Peer> peers, SteadyTime now, Tick tick,
              const VehicleOptions& options);
  // What the last Update found changed.
  std::span<const FreshnessChange> Items() const { return items_; }

 private:
  std::vector<VehicleId> heard_;  // with a beacon young enough, in order
  std::vector<VehicleId> heard_before_;
  std::vector<FreshnessChange> items_;
};

}  // namespace giveway

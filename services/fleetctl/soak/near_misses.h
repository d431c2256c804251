// Which vehicles came near each other, how near and where, by the truth. Bodies are taken as discs
// round their axle centres with their largest radius: a box may have been further away than
// reported, never nearer. Each encounter counts once, at its smallest gap. Bounded. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "services/fleetctl/soak/soak_result.h"
#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

class NearMisses {
 public:
  // Shell to shell; an encounter starts nearer than kNear_m and ends further than kApart_m.
  static constexpr double kNear_m = 0.15;
  static constexpr double kApart_m = 0.30;
  // The ones with the smallest gaps are kept.
  static constexpr std::size_t kMostKept = 256;

  explicit NearMisses(std::map<VehicleId, double> radius_m) : radius_m_(std::move(radius_m)) {}

  // Their times are given `lag_s` later: by so much the world's own is behind.
  void Fold(std::span<const Truth> truths, double lag_s = 0);
  // Encounters that are over or in progress, by time.
  std::vector<NearMiss> Narrowest() const;
  std::uint64_t Count() const { return count_; }
  // Of any two, with or without an encounter; nullopt while there are fewer than two.
  std::optional<NearMiss> Nearest() const { return nearest_; }

 private:
  struct Body {
    Truth truth;
    double radius_m = 0;
  };

  void Observe(const Body& body, double lag_s);
  void Keep(const NearMiss& miss);

  std::map<VehicleId, double> radius_m_;
  std::map<VehicleId, Body> newest_;
  std::map<std::pair<VehicleId, VehicleId>, NearMiss> under_way_;
  std::vector<NearMiss> kept_;
  std::optional<NearMiss> nearest_;
  std::uint64_t count_ = 0;
};

// The body radius of each vehicle, metres. In an open fleet a vehicle's place is not known in
// advance: the largest body counts for all.
std::map<VehicleId, double> RadiiOf(const Scenario& scenario, const std::vector<VehicleId>& fleet);

}  // namespace giveway::fleetctl

// The smallest gap between any two vehicles so far, shell to shell, between ticks included. Walls,
// obstacles and doors do not count.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>

#include "services/types/ids.h"
#include "sim_world/body.h"
#include "sim_world/dynamics/collidables.h"
#include "sim_world/geometry/neighbours.h"

namespace giveway::sim {

struct ClosestApproach {
  VehicleId vehicle = kNoVehicle;
  VehicleId other = kNoVehicle;
  double gap_m = 0;  // 0 for a contact
  Vec2 position_world;
  Vec2 other_position_world;
};

// The state of a Separation.
struct SeparationRecord {
  std::optional<ClosestApproach> closest;
  std::map<std::pair<VehicleId, VehicleId>, double> closest_of_pair_m;  // lower id first
};

class Separation {
 public:
  // `every_pair` keeps a record for each pair of vehicles, for Parted; that costs the square of
  // their number.
  explicit Separation(bool every_pair) : every_pair_(every_pair) {}

  // Only pairs at most this far apart can come nearer than any two did before; none before two
  // bodies were observed together.
  std::optional<double> Reach() const;
  // Processes one tick of dt_s, in which bodies moved as `collidables` says to where they now are.
  // `pairs` names at least those within Reach(); before there is a reach, at least the nearest.
  void Observe(std::span<const Body> bodies, const Collidables& collidables,
               std::span<const NearPair> pairs, double dt_s);

  // The closest any two came; none before two bodies were observed together.
  const std::optional<ClosestApproach>& Closest() const { return closest_; }
  // True if every pair still present is now further apart than at its closest, by more than 1 cm;
  // always without records of every pair.
  bool Parted(std::span<const Body> bodies) const;

  SeparationRecord Save() const { return {closest_, closest_of_pair_m_}; }
  void Restore(const SeparationRecord& record) {
    closest_ = record.closest;
    closest_of_pair_m_ = record.closest_of_pair_m;
  }

 private:
  void ObserveEveryPair(std::span<const Body> bodies, const Collidables& collidables, double dt_s);

  bool every_pair_;
  std::map<std::pair<VehicleId, VehicleId>, double> closest_of_pair_m_;  // lower id first
  std::optional<ClosestApproach> closest_;
};

}  // namespace giveway::sim

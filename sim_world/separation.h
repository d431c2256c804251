// How near any two bodies ever came, shell to shell, between ticks included. Walls do not count.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "services/types/ids.h"
#include "sim_world/body.h"
#include "sim_world/motion.h"

namespace giveway::sim {

// Where the unordered pair of two different bodies stands in a list of all pairs.
constexpr std::size_t PairIndex(std::size_t a, std::size_t b) {
  return a < b ? b * (b - 1) / 2 + a : a * (a - 1) / 2 + b;
}
constexpr std::size_t PairCount(std::size_t bodies) { return bodies * (bodies - 1) / 2; }

struct ClosestApproach {
  VehicleId vehicle = kNobody;
  VehicleId other = kNobody;
  double gap_m = 0;  // 0 for a contact
  Vec2 position_world;
  Vec2 other_position_world;
};

class Separation {
 public:
  explicit Separation(std::size_t bodies);

  // Takes in one tick of dt_s: motions[i] is how bodies[i] moved.
  void Observe(std::span<const Body> bodies, std::span<const Motion> motions, double dt_s);

  // The closest any two came; none before two bodies were observed together.
  const std::optional<ClosestApproach>& Closest() const { return closest_; }
  // True if every pair still present is now farther apart than at its closest, by more than 1 cm.
  bool Parted(std::span<const Body> bodies) const;

 private:
  void ObservePair(std::span<const Body> bodies, std::span<const Motion> motions, std::size_t a,
                   std::size_t b, double dt_s);

  std::vector<double> closest_of_pair_m_;  // infinite before the pair was observed
  std::optional<ClosestApproach> closest_;
};

}  // namespace giveway::sim

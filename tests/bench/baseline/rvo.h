// Reciprocal velocity obstacles, after van den Berg, Guy, Lin and Manocha, "Reciprocal n-body
// Collision Avoidance" (ISRR 2009): each vehicle takes half of the change of velocity that keeps it
// clear of each neighbour for a time. A differential drive is steered by a point ahead of its axle,
// which can move in any direction, and is given a disc that holds the body round that point (Snape,
// van den Berg, Guy, Manocha, IROS 2010). A baseline for measuring: each knows the true
// positions and velocities of its neighbours.
#pragma once

#include <vector>

#include "services/types/math/random.h"
#include "services/types/scenario.h"
#include "tests/bench/baseline/half_planes.h"
#include "tests/bench/baseline/pilot.h"

namespace giveway::bench {

// A disc that moves at will.
struct Mover {
  Vec2 position_world;
  Vec2 velocity_world;
  double radius_m = 0;
};

// What the velocity of `own` may be so that, if `other` does the same, the two stay apart for
// horizon_s. Discs that overlap already part within step_s.
HalfPlane ReciprocalPlane(const Mover& own, const Mover& other, double horizon_s, double step_s);

// Neighbours, horizon and jitter as in the examples that came with the paper, at our scale.
struct RvoSettings {
  double horizon_s = 5;
  double neighbour_m = 5;
  std::size_t neighbours = 10;
  double ahead_m = 0.05;     // of the axle: the point that is steered
  double margin_m = 0.05;    // round the disc, for what wheels cannot follow at once
  double jitter_m_s = 1e-4;  // on the wanted velocity, against perfect symmetry
};

class Rvo : public Pilot {
 public:
  explicit Rvo(const Scenario& scenario, const RvoSettings& settings = {});

  void Drive(std::uint32_t tick, std::span<const Seen> fleet,
             std::span<WheelSpeeds> wheels) override;

 private:
  Mover MoverOf(const VehicleOptions& options, const Seen& seen) const;
  void FindPlanes(std::size_t own);
  Vec2 Wanted(const VehicleOptions& options, const Seen& seen);
  WheelSpeeds Follow(const VehicleOptions& options, const Pose& pose, Vec2 velocity_world) const;

  RvoSettings settings_;
  double step_s_;
  std::vector<VehicleOptions> vehicles_;
  Random random_;
  std::vector<Mover> movers_;
  std::vector<std::size_t> nearest_;
  std::vector<HalfPlane> planes_;
};

}  // namespace giveway::bench

// Which vehicles drive nearer to something than the margin they promise, shell to shell and by the
// truth: to another body, a wall, an obstacle or the leaf of a door. Counts only a vehicle that
// moves towards it: a standing vehicle is passed at the other's cost, and one that started near may
// leave.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/dynamics/doors.h"
#include "sim_world/dynamics/obstacles.h"
#include "sim_world/geometry/motion.h"
#include "sim_world/virtual/observed.h"

namespace giveway::sim {

// Moving things other than vehicles. Empty if they are not known.
struct Surroundings {
  std::span<const MovingObstacle> obstacles;
  std::span<const SlidingDoor> doors;
};

// By index in Observed; kNoVehicle: it is no vehicle.
struct TooNear {
  std::uint32_t vehicle = 0;
  VehicleId other = kNoVehicle;
};

class Clearance {
 public:
  Clearance(const Scenario& scenario, double margin_m);

  // Adds a vehicle that the scenario does not name; one of the same id is forgotten.
  void Admit(const VehicleOptions& options);
  void Forget(VehicleId vehicle);

  // Processes one tick. Vehicles in order of their ids, the admitted ones among them. Returns those
  // that come too near from this tick on; valid until the next.
  std::span<const TooNear> Observe(std::span<const Observed> vehicles, const Surroundings& around);

 private:
  struct Track {
    VehicleId vehicle = kNoVehicle;
    RobotModel profile;
    bool reported = false;
  };
  // A wall and what its margin can be touched from.
  struct BoundWall {
    Wall wall;
    Vec2 low_world;
    Vec2 high_world;
  };
  struct Approaching {
    Motion body;
    Vec2 velocity_world;
    double reach_m = 0;  // from its centre: its disc and the margin
  };

  bool IsNear(const Approaching& own, const Outline& other) const;
  bool IsNearBody(const Approaching& own, const Track& track, const Observed& other) const;
  bool IsNearWall(const Approaching& own) const;
  bool IsNearThing(const Approaching& own, const Surroundings& around) const;
  bool FindNear(std::size_t index, std::span<const Observed> vehicles, const Surroundings& around,
                VehicleId* other) const;

  double margin_m_;
  std::vector<BoundWall> walls_;
  std::vector<Track> tracks_;
  std::vector<TooNear> too_near_;
};

}  // namespace giveway::sim

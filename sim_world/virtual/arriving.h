// Who can arrive, said before the run by geometry alone: two bodies that touch if both stand on
// their goals cannot both, and of those who share a goal in that way one can.
#pragma once

#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

struct Arriving {
  std::vector<VehicleId> each;                 // ascending: everyone of these
  std::vector<std::vector<VehicleId>> one_of;  // one of each group, ascending within it
};

// Of the vehicles that have a goal; not of those that join an open fleet.
Arriving WhoCanArrive(const Scenario& scenario);

// Where a vehicle may stand that has nothing but its wheels to know by that it has arrived, and
// whose wheels slip or miscount: three standard deviations of what its heading drifts on the way,
// half of the way again for turning out. One with fixes, or with a limit beyond which it is lost,
// knows it better: three of the fixes' deviations, or of the limit. beyond_m is 0 where nothing
// makes it err: in its goal, then.
struct GoalTolerance {
  Vec2 at_world;
  double beyond_m = 0;  // from the goal
};
GoalTolerance ToleranceOf(const VehicleOptions& options);

}  // namespace giveway::sim

// Which vehicles can arrive, computed before the run from geometry alone: two bodies that touch
// when both stand on their goals cannot both arrive, and of those that share a goal like this one
// can.
#pragma once

#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

struct Arriving {
  std::vector<VehicleId> each;                 // ascending: all of these
  std::vector<std::vector<VehicleId>> one_of;  // one of each group, ascending within it
};

// Of the vehicles that have a goal; not of those that join an open fleet.
Arriving WhoCanArrive(const Scenario& scenario);

// Where a vehicle may stand if only its wheels show that it has arrived, and they slip or miscount:
// three standard deviations of its heading drift over the route, plus half of the route for
// detours. A vehicle with fixes, or with a limit beyond which it is lost, knows better: three
// deviations of the fixes, or of the limit. beyond_m is 0 if nothing causes an error: then it
// stands in its goal.
struct GoalTolerance {
  Vec2 at_world;
  double beyond_m = 0;  // from the goal
};
GoalTolerance ToleranceOf(const VehicleOptions& options);

}  // namespace giveway::sim

// When each vehicle is due: the time it takes alone in the place, and a bound on the delay caused
// by others that depends on the place alone. The bound is what a simple crossing guard achieves who
// lets all others through the place first, one after the other, each from standstill.
#pragma once

#include <vector>

#include "services/types/scenario.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::sim {

// From its start over its waypoints to its goal, metres, in straight lines.
double RouteLength(const VehicleOptions& options);

// Seconds a vehicle alone would take: its route at cruise speed, with acceleration and braking.
double FreeFlowSeconds(const VehicleOptions& options);

// The same with the turns at its waypoints, on the spot.
double AloneSeconds(const VehicleOptions& options);

// Of a generator's vehicles with a goal, by id. through_m: how long the place is in which only one
// can be.
std::vector<DueTime> DueTimes(const Scenario& scenario, double through_m);

}  // namespace giveway::sim

// The path a vehicle is on: along its route, to its goal, or round a crowd.
#pragma once

#include "services/types/vehicle_options.h"
#include "services/vehicle/situation/situation.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// The straight path to the next waypoint or the goal; straight on without either.
OwnCourse UpdatePath(const OwnPose& pose, const VehicleOptions& options, RouteProgress* route,
                     GoalProgress* progress);

// Where steering round obstacles makes no progress, the path is planned on a map of them. `last`:
// what the step before decided.
Escape Detour(const OwnView& s, const PeersNow& near, const LastStep& last, GoalProgress* progress);

}  // namespace giveway

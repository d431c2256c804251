// Which way a vehicle is on: along its route, to its goal, or round a crowd.
#pragma once

#include "services/types/vehicle_options.h"
#include "services/vehicle/situation/situation.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// The straight way to the next waypoint or the goal; straight on without either.
OwnCourse LookAhead(const OwnPose& pose, const VehicleOptions& options, RouteProgress* route,
                    GoalProgress* progress);

// Where steering round what stands leads nowhere, the way is looked up on a map of it. `last`: what
// the step before decided.
Escape Detour(const OwnView& s, const PeersNow& near, const LastStep& last, GoalProgress* progress);

}  // namespace giveway

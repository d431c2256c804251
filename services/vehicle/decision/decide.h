// The fold: every rule proposes, the most restrictive wins, and its name goes with the wheels.
#pragma once

#include "services/vehicle/decision/action.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

Action Decide(const Situation& s);

// The peer this vehicle publishes as `gives_way_to`: the nearest it waits for, or will, and can.
VehicleId GivesWayTo(const Situation& s);

}  // namespace giveway

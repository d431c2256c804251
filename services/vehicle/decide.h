// The fold: every rule proposes, the most restrictive wins, and its name goes with the wheels.
#pragma once

#include "services/vehicle/situation.h"

namespace giveway {

struct Action {
  Decision decision;
  WheelSpeeds target;
  VehicleId blocked_by = kNobody;  // see Steering
  int steer_side = 0;              // which way it turns past something: 1 left, -1 right
  std::optional<double> away_rad;  // see Steering
};

Action Decide(const Situation& s);

// Whom this vehicle says it gives way to: the nearest peer it waits for, or will, and can.
VehicleId GivesWayTo(const Situation& s);

}  // namespace giveway

// What a step does: the decision with its reason, and the wheels that carry it out.
#pragma once

#include <optional>

#include "services/types/decision.h"
#include "services/types/ids.h"
#include "services/types/math/pose.h"

namespace giveway {

struct Action {
  Decision decision;
  WheelSpeeds target;
  VehicleId blocked_by = kNoVehicle;  // see Steering
  int steer_side = 0;  // the side it turns to when passing an obstacle: 1 left, -1 right
  std::optional<double> away_rad;  // see Steering
};

}  // namespace giveway

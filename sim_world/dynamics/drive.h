// How wheels follow a command, limited by the drive's acceleration and the profile's caps, and how
// ground and encoders change the result.
#pragma once

#include <optional>

#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/math/random.h"
#include "services/types/robot_model.h"

namespace giveway::sim {

// The wheel speeds nearest to `wheels` in forward and turn rate that the profile's caps allow.
WheelSpeeds WithinCaps(const RobotModel& profile, WheelSpeeds wheels);

// Wheel speeds dt_s after `current`, moving towards `target`. Each wheel by itself: at the
// profile's deceleration while its speed decreases, at the acceleration while it increases, and one
// after the other through standstill. The caps win over both.
WheelSpeeds MoveWheels(const RobotModel& profile, WheelSpeeds current, WheelSpeeds target,
                       double dt_s);

// The effect of one tick's wheel speeds.
struct Rolled {
  WheelSpeeds ground;  // the speeds of wheels that roll without slip and move the body as it moves
  WheelSpeeds encoders;  // what the encoders count
};

// Wheels with errors move the body differently from how they turn. Draws the tick's slip and
// encoder noise from `random`, with the same draws whichever of them is on. Neither takes the body
// beyond the profile's caps. Without errors both results are `wheels`.
Rolled Roll(const RobotModel& profile, WheelSpeeds wheels, Random random);

// What is wrong with one body's drive in one tick.
struct DriveFault {
  VehicleId vehicle = kNoVehicle;
  double reaches = 1;                // of what was commanded
  std::optional<WheelSpeeds> stuck;  // wheels turn like this, whatever is commanded
  double counts = 1;                 // of what the encoders would count
};

}  // namespace giveway::sim

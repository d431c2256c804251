// How wheels follow a command: limited by the drive's acceleration and the profile's caps.
#pragma once

#include "services/types/pose.h"
#include "services/types/profile.h"

namespace giveway::sim {

// The wheel speeds nearest to `wheels` in forward and turn rate that the profile's caps allow.
WheelSpeeds WithinCaps(const VehicleProfile& profile, WheelSpeeds wheels);

// Wheel speeds dt_s after `current` on the way to `target`. Each wheel on its own: slowed at the
// profile's deceleration while its speed shrinks, sped up at the acceleration while it grows, one
// after the other when it passes through standstill. The caps win over both.
WheelSpeeds MoveWheels(const VehicleProfile& profile, WheelSpeeds current, WheelSpeeds target,
                       double dt_s);

}  // namespace giveway::sim

// How far a body with corners may turn on the spot before one of them is where something was heard:
// what is free straight ahead says nothing of what the rear end sweeps. Pure.
#pragma once

#include <span>

#include "services/types/robot_model.h"

namespace giveway {

// The part of `turn_rad`, to the left, that a body which stands may turn among places where
// something was heard, in the body frame; all of it for a disc. A place that is within the body
// already, for its cell is coarse, forbids turns that take it further in.
double TurnWithinRoom(double turn_rad, const RobotModel& body, std::span<const Vec2> places);

}  // namespace giveway

// Whether a body that appears on a place will be hit there by what moves already: a vehicle drives
// as it does until it has sensed the newcomer, then brakes; an obstacle never brakes for anything.
#pragma once

#include "sim_world/body.h"
#include "sim_world/dynamics/obstacles.h"
#include "sim_world/geometry/motion.h"

namespace giveway::sim {

// Whether the body touches `newcomer`, which stands, before it can have stopped. It brakes after
// `unaware_s` and what its ultrasonics take to go round; until then it may still speed up.
bool HitsWhileStopping(const Body& body, double unaware_s, const Motion& newcomer);

// Whether the obstacle touches the newcomer before that can have driven off its place, which takes
// `leaving_s`; in ticks of dt_s.
bool HitsOnItsCourse(const MovingObstacle& obstacle, double leaving_s, double dt_s,
                     const Motion& newcomer);

// How long a vehicle takes from standstill to drive off the place on which it stands.
double LeavingSeconds(const RobotModel& profile);

}  // namespace giveway::sim

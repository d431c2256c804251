// What follows from how the ultrasonics are mounted, worked out once and not every tick.
#pragma once

#include <array>
#include <cstdint>

#include "services/types/robot_model.h"

namespace giveway {

// One transducer's cone, in the body frame.
struct Cone {
  Vec2 axis_body;         // unit vector
  Vec2 nearest_body;      // unit vector of the ray in it that is nearest to straight ahead
  double nearest_cosine;  // of the angle between that ray and straight ahead
  double bearing_rad;     // of the axis
};

struct Cones {
  std::array<Cone, kSensorCount> of;
  double half_sine;  // of half the angle of any of them
  // Of the angle to either side of straight ahead up to which enabled cones leave no gap; at most
  // a quarter turn.
  double ahead_sine;
  double ahead_cosine;
  std::uint32_t enabled;  // bit i for sensor i
  std::uint32_t amid;     // of these, whose cone leaves no gap to others on either side
};

Cones ConesOf(const RobotModel& profile);

}  // namespace giveway

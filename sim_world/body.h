// One vehicle's body as the world keeps it, and what happens to bodies.
#pragma once

#include "services/types/ids.h"
#include "services/types/motor_command.h"
#include "services/types/pose.h"
#include "services/types/vehicle_options.h"
#include "sim_world/sonar.h"

namespace giveway::sim {

struct Body {
  VehicleId vehicle = kNobody;
  VehicleProfile profile;
  Goal goal;
  bool joined = false;
  bool present = false;  // joined and not removed: stands in the way and is sensed
  Pose world_from_body;
  WheelSpeeds wheels;    // at the end of the tick; standstill after a contact
  WheelSpeeds encoders;  // the constant speeds that explain the whole tick's motion exactly
  Readings readings{};
  MotorCommand command;  // the last one taken; tick kNoTick before the first
  bool obeyed = false;   // this tick followed `command`; false: braked by the world itself

  double ForwardSpeed() const { return TwistFromWheels(profile.drive, wheels).forward_m_s; }
};

// Two shells, or a shell and a wall, that began to touch in this tick.
struct Contact {
  VehicleId vehicle = kNobody;
  VehicleId other = kNobody;  // kNobody: a wall
  Vec2 position_world;        // of the vehicle's axle centre
  Vec2 other_position_world;  // of the other's; of the touched point for a wall
};

}  // namespace giveway::sim

// One vehicle's body in the world, and the contacts of bodies.
#pragma once

#include <cstdint>

#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/motor_command.h"
#include "services/types/vehicle_options.h"
#include "sim_world/sensors/sonar.h"

namespace giveway::sim {

// Fields that every tick reads come first, next to each other.
struct Body {
  VehicleId vehicle = kNoVehicle;
  bool joined = false;
  bool present = false;  // joined and not removed: can be hit and is sensed
  bool obeyed = false;   // this tick followed `command`; false: braked by the world itself
  Pose world_from_body;
  CachedHeading heading;  // recently; follow `world_from_body` before use
  WheelSpeeds wheels;     // at the end of the tick; standstill after a contact
  WheelSpeeds encoders;   // counted over the whole tick; without encoder noise and slip, the
                          // constant speeds that explain its motion exactly
  WheelAngles counted;    // by the encoders, since it was put on its start pose
  WheelSpeeds ground;     // the constant speeds that do explain it, slip included
  MotorCommand command;   // the last one taken; tick kNoTick before the first
  RobotModel profile;
  SonarState sonar;
  Goal goal;
  Pose start_world;
  Nanoseconds sonar_refresh{0};  // as VehicleOptions::sonar_refresh

  double ForwardSpeed() const { return TwistFromWheels(profile.drive, wheels).forward_m_s; }
};

enum class Touched : std::uint8_t { kVehicle, kWall, kObstacle, kDoor };

// Two shells, or a shell and something that is not a vehicle, that started to touch in this tick.
struct Contact {
  VehicleId vehicle = kNoVehicle;
  VehicleId other = kNoVehicle;  // kNoVehicle: no vehicle
  Vec2 position_world;           // of the vehicle's axle centre
  Vec2 other_position_world;     // of the other's; of the touched point where it is no vehicle
  Touched touched = Touched::kVehicle;
};

}  // namespace giveway::sim

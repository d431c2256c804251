// The state of a world from which a restarted one continues. A value; how it is stored is up to the
// caller.
#pragma once

#include <cstdint>
#include <vector>

#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/motor_command.h"
#include "sim_world/active_contacts.h"
#include "sim_world/dynamics/obstacles.h"
#include "sim_world/separation.h"

namespace giveway::sim {

struct BodyState {
  VehicleId vehicle = kNoVehicle;
  Pose world_from_body;
  WheelSpeeds wheels;
  WheelAngles counted;
  MotorCommand command;  // the one held
  bool present = true;   // false: it was removed from there
};

struct Checkpoint {
  Tick now = kNoTick;
  std::uint32_t driven_ticks = 0;  // since the start signal
  std::uint32_t contacts = 0;
  std::vector<BodyState> bodies;         // of those that joined
  std::vector<ObstacleState> obstacles;  // in the order of the scenario
  std::vector<double> door_openings;     // in the order of the scenario, [0, 1]
  std::vector<ContactPair> touching;
  SeparationRecord separation;
};

}  // namespace giveway::sim

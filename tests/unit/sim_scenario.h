// Small scenarios and commands for the tests of the world.
#pragma once

#include <vector>

#include "services/types/motor_command.h"
#include "services/types/scenario.h"

namespace giveway::sim {

inline constexpr WorldEpoch kEpoch{7};

inline VehicleOptions VehicleAt(std::uint32_t id, Pose start_world) {
  VehicleOptions options;
  options.id = VehicleId{id};
  options.profile = PioneerP3dx();
  options.start_world = start_world;
  return options;
}

inline Scenario ScenarioOf(std::vector<VehicleOptions> vehicles) {
  Scenario scenario;
  scenario.name = "test";
  scenario.vehicles = std::move(vehicles);
  return scenario;
}

// A command for both wheels that answers `tick`.
inline MotorCommand Drive(std::uint32_t id, Tick tick, double left_rad_s, double right_rad_s) {
  MotorCommand command;
  command.vehicle = VehicleId{id};
  command.epoch = kEpoch;
  command.tick = tick;
  command.target = {left_rad_s, right_rad_s};
  return command;
}

}  // namespace giveway::sim

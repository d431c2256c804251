// Small scenarios and commands for the tests of the world.
#pragma once

#include <vector>

#include "services/types/motor_command.h"
#include "services/types/scenario.h"
#include "sim_world/world.h"

namespace giveway::sim {

inline constexpr WorldEpoch kEpoch{7};
inline constexpr double kDt_s = 0.05;  // of a tick
inline constexpr VehicleId kOne{1};
inline constexpr VehicleId kTwo{2};

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

// A world in which all of the scenario's vehicles have joined.
inline World WorldOf(const Scenario& scenario) {
  World world(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) world.Join(options.id);
  return world;
}

// Gives every vehicle the same command, tick after tick.
inline void DriveAll(World* world, double left_rad_s, double right_rad_s, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    for (const Body& body : world->Bodies()) {
      world->Take(Drive(Number(body.vehicle), world->Now(), left_rad_s, right_rad_s));
    }
    world->Advance(true);
  }
}

}  // namespace giveway::sim

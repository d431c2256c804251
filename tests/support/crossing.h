// Scenarios in code for tests that run world and brains in memory.
#pragma once

#include <algorithm>
#include <set>

#include "services/types/math/math.h"
#include "services/types/scenario.h"
#include "sim_world/virtual/virtual_fleet.h"

namespace giveway::test {

inline VehicleOptions VehicleAt(std::uint32_t id, Behaviour behaviour, double cruise_m_s, Vec2 from,
                                double heading_deg, double goal_after_m) {
  VehicleOptions options;
  options.id = VehicleId{id};
  options.behaviour = behaviour;
  options.profile = PioneerP3dx();
  options.cruise_m_s = cruise_m_s;
  options.start_world = {.position_world = from, .heading_rad = Radians(heading_deg)};
  options.goal = {.set = goal_after_m > 0,
                  .at_world = from + goal_after_m * Forward(options.start_world)};
  options.braitenberg = WeightsOf(behaviour);
  return options;
}

inline Scenario ScenarioOf(std::vector<VehicleOptions> vehicles) {
  Scenario scenario;
  scenario.name = "test";
  scenario.duration_s = 60;
  scenario.vehicles = std::move(vehicles);
  return scenario;
}

// Vehicle 1 comes from the west, vehicle 2 from the south, timed to reach the origin together.
inline Scenario Crossing(Behaviour behaviour, double cruise_1_m_s, double cruise_2_m_s) {
  constexpr double kWay_m = 4.0;
  // Both accelerate at 0.3 m/s^2: the ramp costs v / (2 * 0.3) seconds.
  const double time_s = kWay_m / cruise_1_m_s + cruise_1_m_s / 0.6;
  const double way_2 = (time_s - cruise_2_m_s / 0.6) * cruise_2_m_s;
  return ScenarioOf({VehicleAt(1, behaviour, cruise_1_m_s, {-kWay_m, 0}, 0, kWay_m + 2.5),
                     VehicleAt(2, behaviour, cruise_2_m_s, {0, -way_2}, 90, way_2 + 2.5)});
}

// The outcome of a finished run.
struct Outcome {
  std::set<std::uint32_t> halted;
  std::set<std::uint32_t> arrived;
  std::uint32_t halts = 0;
  RunFigures figures;
};

inline Outcome Finish(const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  fleet.Finish();
  Outcome outcome;
  for (const WorldEvent& event : fleet.History()) {
    if (event.kind == EventKind::kHalted) {
      outcome.halted.insert(Number(event.vehicle));
      ++outcome.halts;
    }
    if (event.kind == EventKind::kArrived) outcome.arrived.insert(Number(event.vehicle));
  }
  outcome.figures = fleet.World().Figures();
  return outcome;
}

}  // namespace giveway::test

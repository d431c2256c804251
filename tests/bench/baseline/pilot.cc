#include "tests/bench/baseline/pilot.h"

#include <algorithm>

#include "sim_world/run/run.h"
#include "sim_world/virtual/virtual_fleet.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::bench {
namespace {

constexpr WorldEpoch kEpoch{1};

// A pilot needs no ultrasonics, and they are what a world spends its time on.
Scenario WithoutSonar(Scenario scenario) {
  for (VehicleOptions& options : scenario.vehicles) options.profile.sonar = {};
  return scenario;
}

// Vehicles are few: looked up one by one.
const VehicleOptions& OptionsOf(const Scenario& scenario, VehicleId vehicle) {
  return *std::ranges::find(scenario.vehicles, vehicle, &VehicleOptions::id);
}

// Which vehicles reached their goal, standing there or passing it: one rule for all pilots. A
// vehicle booked through tiles passes its goal at cruise speed, and the judge's word, "stands in
// it", would count how it brakes.
class Finish {
 public:
  explicit Finish(const Scenario& scenario)
      : scenario_(scenario), came_(scenario.vehicles.size(), false) {}

  // After each tick.
  void Watch(const sim::Run& run) {
    std::size_t index = 0;
    for (const Truth& truth : run.Truths()) {
      const VehicleOptions& options = OptionsOf(scenario_, truth.vehicle);
      const double away_m = Norm(options.goal.at_world - truth.world_from_body.position_world);
      if (!came_[index] && away_m <= options.goal.radius_m) {
        came_[index] = true;
        crossed_.took_s = run.TimeSeconds();
        crossed_.delays_s.push_back(crossed_.took_s - AloneSeconds(options));
        ++crossed_.arrived;
      }
      ++index;
    }
  }
  bool Came(std::size_t index) const { return came_[index]; }
  bool AllCame() const { return crossed_.arrived == came_.size(); }

  Crossed Conclude(const sim::Run& run) {
    const RunFigures figures = run.Figures();
    crossed_.vehicles = static_cast<std::uint32_t>(came_.size());
    crossed_.contacts = figures.contacts;
    crossed_.separation_m = figures.min_separation_m;
    if (!AllCame()) crossed_.took_s = run.TimeSeconds();
    for (std::size_t i = 0; i < came_.size(); ++i) {
      if (came_[i]) continue;
      crossed_.delays_s.push_back(run.TimeSeconds() - AloneSeconds(scenario_.vehicles[i]));
    }
    return crossed_;
  }

 private:
  const Scenario& scenario_;
  std::vector<bool> came_;
  Crossed crossed_;
};

void See(const sim::Run& run, const Finish& finish, std::vector<Seen>* fleet) {
  std::size_t index = 0;
  for (const Truth& truth : run.Truths()) {
    (*fleet)[index] = {truth.world_from_body, truth.wheels, finish.Came(index)};
    ++index;
  }
}

}  // namespace

double AloneSeconds(const VehicleOptions& options) {
  const double braking_s = options.cruise_m_s / (2 * options.profile.deceleration_m_s2);
  return sim::FreeFlowSeconds(options) - braking_s;
}

Crossed RunWithPilot(const Scenario& scenario, Pilot* pilot) {
  sim::Run run(WithoutSonar(scenario), kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  run.Start();
  Finish finish(scenario);
  std::vector<Seen> fleet(scenario.vehicles.size());
  std::vector<WheelSpeeds> wheels(scenario.vehicles.size());
  std::vector<MotorCommand> commands;
  for (std::uint32_t tick = 0; run.State() != RunState::kEnded; ++tick) {
    run.Advance(commands);
    finish.Watch(run);
    if (finish.AllCame()) run.End("all_came");  // takes effect with the next tick
    See(run, finish, &fleet);
    pilot->Drive(tick, fleet, wheels);
    commands.clear();
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      commands.push_back({.vehicle = scenario.vehicles[i].id,
                          .epoch = kEpoch,
                          .tick = run.Now(),
                          .target = wheels[i]});
    }
  }
  return finish.Conclude(run);
}

Crossed RunWithBrains(const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  Finish finish(scenario);
  while (fleet.Advance()) finish.Watch(fleet.World());
  finish.Watch(fleet.World());
  return finish.Conclude(fleet.World());
}

}  // namespace giveway::bench

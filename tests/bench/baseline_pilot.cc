#include "tests/bench/baseline_pilot.h"

#include <algorithm>

#include "sim_world/run.h"
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

void Take(const Scenario& scenario, const WorldEvent& event, Crossed* crossed) {
  if (event.kind != EventKind::kArrived) return;
  ++crossed->arrived;
  crossed->delays_s.push_back(event.value - AloneSeconds(OptionsOf(scenario, event.vehicle)));
}

void Conclude(const Scenario& scenario, const sim::Run& run, Crossed* crossed) {
  const RunFigures figures = run.Figures();
  crossed->vehicles = static_cast<std::uint32_t>(scenario.vehicles.size());
  crossed->contacts = figures.contacts;
  crossed->separation_m = figures.min_separation_m;
  crossed->took_s = figures.time_to_clear_s.value_or(run.TimeSeconds());
  for (const Truth& truth : run.Truths()) {
    if (truth.arrived) continue;
    crossed->delays_s.push_back(run.TimeSeconds() -
                                AloneSeconds(OptionsOf(scenario, truth.vehicle)));
  }
}

void See(const sim::Run& run, std::vector<Seen>* fleet) {
  std::size_t index = 0;
  for (const Truth& truth : run.Truths()) {
    (*fleet)[index++] = {truth.world_from_body, truth.wheels, truth.arrived};
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
  Crossed crossed;
  std::vector<Seen> fleet(scenario.vehicles.size());
  std::vector<WheelSpeeds> wheels(scenario.vehicles.size());
  std::vector<MotorCommand> commands;
  for (std::uint32_t tick = 0; run.State() != RunState::kEnded; ++tick) {
    run.Advance(commands);
    for (const WorldEvent& event : run.Events()) Take(scenario, event, &crossed);
    See(run, &fleet);
    pilot->Drive(tick, fleet, wheels);
    commands.clear();
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      commands.push_back({.vehicle = scenario.vehicles[i].id,
                          .epoch = kEpoch,
                          .tick = run.Now(),
                          .target = wheels[i]});
    }
  }
  Conclude(scenario, run, &crossed);
  return crossed;
}

Crossed RunWithBrains(const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  fleet.Finish();
  Crossed crossed;
  for (const WorldEvent& event : fleet.History()) Take(scenario, event, &crossed);
  Conclude(scenario, fleet.World(), &crossed);
  return crossed;
}

}  // namespace giveway::bench

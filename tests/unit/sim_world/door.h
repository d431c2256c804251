// A world, its admission, and vehicles that drive as soon as they have joined.
#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include "sim_world/run/admission.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {

inline VehicleOptions SpawnAt(double x_m) {
  VehicleOptions options = VehicleAt(0, {{x_m, 0}, 0});
  options.id = kNoVehicle;
  return options;
}

// Vehicle 2 is named; two places are open to any vehicle.
inline Scenario OpenScenario() {
  Scenario scenario = ScenarioOf({VehicleAt(2, {{0, 10}, 0})});
  scenario.spawns = {SpawnAt(0), SpawnAt(10)};
  scenario.remove_after_s = 2;
  return scenario;
}

inline Scenario ClosedScenario() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{0, 10}, 0})});
  scenario.faults = {{.kind = FaultKind::kKill, .vehicle = VehicleId{1}, .at_s = 0.5}};
  scenario.remove_after_s = 2;
  return scenario;
}

inline JoinRequest Ask(std::uint32_t session, std::uint32_t wanted = 0) {
  return {.session = {session, 0, 0, 1}, .wanted = VehicleId{wanted}};
}

// A world, its admission, and vehicles that drive straight on as soon as they have joined.
class Door {
 public:
  explicit Door(const Scenario& scenario, WorldEpoch epoch = kEpoch)
      : run(scenario, epoch), admission(scenario, epoch, &run), epoch_(epoch) {}

  void Tick(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      answers.clear();
      for (const RosterEntry& entry : admission.Answer()) answers.push_back(entry);
      std::vector<MotorCommand> commands;
      for (const auto& [vehicle, entry] : admission.Informed()) {
        if (dead.contains(vehicle)) continue;
        commands.push_back(Drive(Number(vehicle), run.Now(), speed_rad_s, speed_rad_s));
        commands.back().epoch = epoch_;
      }
      run.Advance(commands);
      admission.FollowRun();
      for (const WorldEvent& event : run.Events()) events.push_back(event);
    }
  }
  // The answer of the tick in which it asks.
  RosterEntry Join(const JoinRequest& request) {
    admission.Take(request);
    Tick();
    for (const RosterEntry& entry : answers) {
      if (entry.session == request.session) return entry;
    }
    return {};
  }
  void Leave(std::uint32_t session) {
    JoinRequest request = Ask(session);
    request.leaving = true;
    admission.Take(request);
  }
  std::size_t Count(EventKind kind) const {
    return static_cast<std::size_t>(std::ranges::count(events, kind, &WorldEvent::kind));
  }

  Run run;
  Admission admission;
  std::set<VehicleId> dead;
  double speed_rad_s = 3;
  std::vector<RosterEntry> answers;  // of the last tick
  std::vector<WorldEvent> events;

 private:
  WorldEpoch epoch_;
};

}  // namespace giveway::sim

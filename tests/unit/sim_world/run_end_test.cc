// What ends a run, and what a run may rely on to end it.
#include <gtest/gtest.h>

#include "sim_world/run/run.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

Scenario Two() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{0, 2}, 0})});
  for (VehicleOptions& options : scenario.vehicles) {
    options.goal = {.set = true, .at_world = options.start_world.position_world + Vec2{2, 0}};
  }
  return scenario;
}

// Two vehicles without a process.
std::string EndOf(const Scenario& scenario) {
  Run run(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  run.Start();
  for (int i = 0; i < 100 && run.State() != RunState::kEnded; ++i) run.Advance({});
  EXPECT_FALSE(run.Figures().passed);
  EXPECT_EQ(run.Figures().reason, run.EndReason());
  return run.EndReason();
}

TEST(RunEnd, ARunInWhichNoVehicleLivesAnyMoreHasNotPassedThoughAllWasPlanned) {
  Scenario scenario = Two();
  scenario.faults = {{.vehicle = VehicleId{1}, .at_s = 0}, {.vehicle = VehicleId{2}, .at_s = 0}};
  EXPECT_EQ(EndOf(scenario), "no_vehicle_lives");
  scenario.faults.pop_back();
  EXPECT_EQ(EndOf(scenario), "process_died");
}

// Regression: of the longest tick allowed, one was a second of silence, and the command that
// answers it comes with the next: every closed run ended at once.
TEST(RunEnd, AVehicleThatAnswersEveryTickIsNeverSilentHoweverLongATickIs) {
  Scenario scenario = Two();
  scenario.tick_period = Nanoseconds{1'000'000'000};
  sim::Run run(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  run.Start();
  std::vector<MotorCommand> commands;
  for (int i = 0; i < 20; ++i) {
    run.Advance(commands);
    EXPECT_EQ(run.State(), RunState::kRunning) << "tick " << i << ": " << run.EndReason();
    commands = {Drive(1, run.Now(), 0, 0), Drive(2, run.Now(), 0, 0)};
  }
  for (int i = 0; i < 2; ++i) run.Advance({});
  EXPECT_EQ(run.State(), RunState::kRunning);
  for (int i = 0; i < 2; ++i) run.Advance({});
  EXPECT_EQ(run.EndReason(), "process_died");
}

TEST(RunEnd, ALoopHasNoGoalToEndIn) {
  Scenario scenario = Two();
  Route& route = scenario.vehicles[1].route;
  route.waypoints_world[0] = {9, 0};
  route.count = 1;
  route.loop = true;
  sim::Run run(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  EXPECT_TRUE(run.BodyOf(VehicleId{1})->goal.set);
  EXPECT_FALSE(run.BodyOf(VehicleId{2})->goal.set);
}

}  // namespace
}  // namespace giveway::sim

// Which vehicles can arrive, when, and how near with slipping wheels.
#include "sim_world/virtual/arriving.h"

#include <gtest/gtest.h>

#include "sim_world/virtual/due_times.h"
#include "sim_world/virtual/generators.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::sim {
namespace {

VehicleOptions Towards(std::uint32_t id, Vec2 goal) {
  VehicleOptions options;
  options.id = VehicleId{id};
  options.profile = PioneerP3dx();
  options.goal = {.set = true, .at_world = goal};
  return options;
}

TEST(WhoCanArrive, OfTwoThatShareAGoalOne) {
  Scenario scenario;
  scenario.vehicles = {Towards(1, {5, 0}), Towards(2, {0, 5}), Towards(3, {5.1, 0})};
  const Arriving arriving = WhoCanArrive(scenario);
  EXPECT_EQ(arriving.each, (std::vector{VehicleId{2}}));
  ASSERT_EQ(arriving.one_of.size(), 1U);
  EXPECT_EQ(arriving.one_of[0], (std::vector{VehicleId{1}, VehicleId{3}}));
}

// Each at the far rim of its goal: bodies of 0.5 m fit between goals 0.31 m apart.
TEST(WhoCanArrive, NextToEachOtherBoth) {
  Scenario scenario;
  scenario.vehicles = {Towards(1, {5, 0}), Towards(2, {5.31, 0})};
  EXPECT_EQ(WhoCanArrive(scenario).each.size(), 2U);
}

TEST(WhoCanArrive, NobodyWithoutAGoal) {
  Scenario scenario;
  scenario.vehicles = {Towards(1, {5, 0})};
  scenario.vehicles[0].goal.set = false;
  EXPECT_TRUE(WhoCanArrive(scenario).each.empty());
}

TEST(GoalTolerances, AreForWheelsThatSlip) {
  VehicleOptions options = Towards(1, {10, 0});
  EXPECT_EQ(ToleranceOf(options).beyond_m, 0);
  options.profile.wheel_slip = 0.02;
  const double slips_m = ToleranceOf(options).beyond_m;
  EXPECT_GT(slips_m, 0.3);
  EXPECT_LT(slips_m, 2);
  options.profile.encoder_noise = 0.02;
  EXPECT_GT(ToleranceOf(options).beyond_m, slips_m);
}

// A vehicle knows its position no better than its wheels do; at the end of the run it still stands
// there.
TEST(GoalTolerances, WhoStandsWithinHasArrivedWhenTheRunEnds) {
  Scenario scenario = MakeCrossing({2, 3});
  for (VehicleOptions& options : scenario.vehicles) options.profile.wheel_slip = 0.02;
  const VirtualOutcome outcome = RunVirtually(scenario, {});
  EXPECT_EQ(outcome.violations[static_cast<std::size_t>(Invariant::kArrival)], 0U);
  EXPECT_EQ(outcome.arrived, 2U);
}

// 10 m at 0.5 m/s alone, and a second vehicle that takes 2 m at 0.25 m/s from standstill.
TEST(DueTimesOfAPlace, GrowByWhatTheOthersNeed) {
  Scenario scenario;
  scenario.vehicles = {Towards(1, {10, 0}), Towards(2, {0, 5})};
  scenario.vehicles[0].cruise_m_s = 0.5;
  scenario.vehicles[1].cruise_m_s = 0.25;
  const std::vector<DueTime> due = DueTimes(scenario, 2);
  ASSERT_EQ(due.size(), 2U);
  const double alone_s = AloneSeconds(scenario.vehicles[0]);
  EXPECT_GE(alone_s, 19.8);
  EXPECT_NEAR(due[0].at_s, alone_s + 20 + 2 / 0.25 + 0.25 / 0.6, 1e-9);
  EXPECT_GT(DueTimes(scenario, 10)[0].at_s, due[0].at_s);
}

// Regression: a user's file of the name "shared_goal" was excused as the generator's places are.
TEST(DueTimesOfAPlace, AreOfAPlaceThatThePlanSaysWhateverItsName) {
  Scenario scenario = FindGenerator("shared_goal")->make({4, 1});
  EXPECT_TRUE(LimitsFor(scenario, VirtualPlan{}).one_of.empty());
  EXPECT_TRUE(LimitsFor(scenario, VirtualPlan{}).due.empty());
  scenario.name = "shared_goal_1";
  VirtualPlan plan;
  plan.through_m = 2;
  EXPECT_FALSE(LimitsFor(scenario, plan).one_of.empty());
  EXPECT_EQ(LimitsFor(scenario, plan).due.size(), 4U);
}

TEST(DueTimesOfAPlace, AllowForTurning) {
  VehicleOptions options = Towards(1, {10, 0});
  const double ahead_s = AloneSeconds(options);
  options.start_world.heading_rad = 3;
  EXPECT_NEAR(AloneSeconds(options) - ahead_s, 3 / (0.5 * 1.74), 1e-9);
}

}  // namespace
}  // namespace giveway::sim

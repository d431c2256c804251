// A virtual run repeats bit for bit, and processes fail in it as they do in reality.
#include "sim_world/virtual/virtual_fleet.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim_world/virtual/generators.h"
#include "sim_world/virtual/virtual_run.h"
#include "tests/support/crossing.h"

namespace giveway::sim {
namespace {

Scenario ALongRoad() {
  return test::ScenarioOf({test::VehicleAt(1, Behaviour::kCooperative, 0.4, {0, 0}, 0, 8),
                           test::VehicleAt(2, Behaviour::kCooperative, 0.4, {0, 3}, 0, 8)});
}

VirtualPlan Lossy(std::uint64_t seed) {
  VirtualPlan plan;
  plan.seed = seed;
  plan.radio = {.loss = 0.1,
                .burst = {.enter = 0.01},
                .jitter = Nanoseconds(80'000'000),
                .reorder = 0.02,
                .duplicate = 0.02};
  return plan;
}

void Advance(VirtualFleet* fleet, int ticks) {
  for (int i = 0; i < ticks; ++i) ASSERT_TRUE(fleet->Advance());
}

TEST(VirtualRun, TheSameSeedGivesTheSameHashAndAnotherAnother) {
  const Scenario scenario = MakeCrossing({4, 2});
  const std::uint64_t once = RunVirtually(scenario, Lossy(1)).hash;
  EXPECT_EQ(RunVirtually(scenario, Lossy(1)).hash, once);
  EXPECT_NE(RunVirtually(scenario, Lossy(2)).hash, once);
}

TEST(VirtualRun, DelaysAreMeasuredAgainstDrivingAlone) {
  const VirtualOutcome outcome = RunVirtually(ALongRoad(), {});
  EXPECT_TRUE(outcome.held);
  ASSERT_EQ(outcome.delays_s.size(), 2U);
  for (const double delay_s : outcome.delays_s) EXPECT_NEAR(delay_s, 0, 0.6);
}

TEST(VirtualRun, CountsWhatItSimulated) {
  const VirtualOutcome outcome = RunVirtually(ALongRoad(), {});
  EXPECT_NEAR(outcome.vehicle_seconds, 2 * outcome.ticks * 0.05, 1e-6);
}

TEST(VirtualFleet, ACrashedVehicleFallsSilentAndIsNotWaitedFor) {
  VirtualPlan plan;
  plan.faults = {{.kind = ProcessFaultKind::kCrash, .vehicle = VehicleId{2}, .at_s = 3}};
  const VirtualOutcome outcome = RunVirtually(ALongRoad(), plan);
  EXPECT_TRUE(outcome.held);
  EXPECT_EQ(outcome.delays_s.size(), 1U);
}

TEST(VirtualFleet, APausedVehicleSaysNothingBrakesAndGoesOn) {
  VirtualPlan plan;
  plan.faults = {
      {.kind = ProcessFaultKind::kPause, .vehicle = VehicleId{2}, .at_s = 4, .for_s = 0.7}};
  VirtualFleet fleet(ALongRoad(), plan);
  Advance(&fleet, 79);
  EXPECT_TRUE(fleet.Answered(1));
  Advance(&fleet, 14);
  EXPECT_FALSE(fleet.Answered(1));
  EXPECT_EQ(fleet.OutputsOf(1).command.tick, Tick{79});
  EXPECT_LT(fleet.World().Truths()[1].forward_m_s, 0.2);
  Advance(&fleet, 1);
  EXPECT_TRUE(fleet.Answered(1));
  EXPECT_EQ(fleet.OutputsOf(1).beacon.boot_epoch, 2U);
  // Of what was said meanwhile its reader kept the last four, and one is new.
  EXPECT_EQ(fleet.Brain(1).State().counters.beacons.taken, 78U + 5U);
  fleet.Finish();
  EXPECT_EQ(fleet.World().EndReason(), "all_arrived");
}

TEST(VirtualFleet, ARestartedVehicleBeginsANewLifeWhereItStands) {
  VirtualPlan plan;
  plan.faults = {
      {.kind = ProcessFaultKind::kRestart, .vehicle = VehicleId{2}, .at_s = 4, .for_s = 0.5}};
  VirtualFleet fleet(ALongRoad(), plan);
  Advance(&fleet, 95);
  EXPECT_EQ(fleet.OutputsOf(1).beacon.boot_epoch, 3U);
  EXPECT_EQ(fleet.OutputsOf(1).beacon.seq, 6U);
  const Vec2 truth = fleet.World().Truths()[1].world_from_body.position_world;
  EXPECT_NEAR(fleet.OutputsOf(1).beacon.world_from_body.position_world.x, truth.x, 1e-6);
  fleet.Finish();
  EXPECT_EQ(fleet.World().EndReason(), "all_arrived");
}

// It went back to its first waypoint.
TEST(VirtualFleet, ARestartedVehicleGoesOnAlongItsRoute) {
  Scenario scenario = ALongRoad();
  VehicleOptions& two = scenario.vehicles[1];
  two.route = {.waypoints_world = {{{2, 3}, {4, 3}, {4, 5}}}, .count = 3};
  two.goal.at_world = {2, 5};
  VirtualPlan plan;
  plan.faults = {
      {.kind = ProcessFaultKind::kRestart, .vehicle = VehicleId{2}, .at_s = 9, .for_s = 0.5}};
  VirtualFleet fleet(scenario, plan);
  Advance(&fleet, 178);
  EXPECT_EQ(fleet.Brain(1).State().route.waypoint, 1U);
  const double x_m = fleet.World().Truths()[1].world_from_body.position_world.x;
  Advance(&fleet, 14);
  EXPECT_EQ(fleet.OutputsOf(1).beacon.boot_epoch, 3U);
  EXPECT_EQ(fleet.Brain(1).State().route.waypoint, 1U);
  double least_x_m = 1e9;
  while (fleet.Brain(1).State().route.waypoint == 1) {
    Advance(&fleet, 1);
    least_x_m = std::min(least_x_m, fleet.World().Truths()[1].world_from_body.position_world.x);
  }
  EXPECT_GE(least_x_m, x_m);
  const VirtualOutcome outcome = RunVirtually(scenario, plan);
  EXPECT_TRUE(outcome.held);
  EXPECT_EQ(outcome.delays_s.size(), 2U);
}

TEST(VirtualFleet, TheOthersHearOfASilentOneWhatTheMiddlewareWouldSay) {
  VirtualPlan plan;
  plan.faults = {{.kind = ProcessFaultKind::kCrash, .vehicle = VehicleId{2}, .at_s = 3}};
  VirtualFleet fleet(ALongRoad(), plan);
  Advance(&fleet, 80);
  EXPECT_EQ(fleet.Brain(0).State().counters.qos.deadline_missed, 1U);
  EXPECT_EQ(fleet.Brain(0).State().counters.qos.liveliness_lost, 1U);
}

TEST(VirtualFleet, WhatTheRadioLosesTheBrainCountsAsLost) {
  VirtualPlan plan;
  plan.seed = 3;
  plan.radio.loss = 0.3;
  VirtualFleet fleet(ALongRoad(), plan);
  Advance(&fleet, 400);
  const BeaconCounters& counters = fleet.Brain(0).State().counters.beacons;
  EXPECT_NEAR(counters.lost, 0.3 * 400, 45);
  EXPECT_NEAR(counters.taken + counters.lost, 399, 6);
}

// Regression: vehicles met in the middle of a passage one body wide, and none arrived.
TEST(VirtualRun, EveryVehicleGetsThroughAPassageOneBodyWide) {
  for (const char* name : {"door", "one_lane"}) {
    for (const SonarTier tier : {SonarTier::kIdeal, SonarTier::kTypical}) {
      for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        Scenario scenario = FindGenerator(name)->make({6, seed});
        scenario.sonar.tier = tier;
        for (VehicleOptions& vehicle : scenario.vehicles) {
          vehicle.sonar_noise = tier == SonarTier::kIdeal ? 0 : scenario.sonar.noise;
        }
        const VirtualOutcome outcome = RunVirtually(scenario, {});
        EXPECT_TRUE(outcome.held) << name << " " << seed;
        EXPECT_EQ(outcome.delays_s.size(), 6U) << name << " " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace giveway::sim

// What a drawn fleet is, and that a seed without the draws means the same as before.
#include "services/fleetctl/virtual/fleet_draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "services/config/braking_rules.h"
#include "services/config/problem.h"
#include "services/fleetctl/virtual/virtual_case.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {
namespace {

CaseOptions MixedOf(const std::string& generator) {
  CaseOptions options;
  options.scenario = generator;
  options.vehicles = WholeRange{12, 12};
  options.fleet = {.mixed_robots = true,
                   .tiers = {SonarTier::kIdeal, SonarTier::kTypical, SonarTier::kP3dx},
                   .most_slip = 0.02};
  return options;
}

template <typename Check>
void OnManySeeds(const CaseOptions& options, Check check) {
  const CaseMaker maker(options);
  for (std::uint32_t seed = 1; seed <= 40; ++seed) check(maker.Make(seed).scenario);
}

TEST(FleetDraw, EveryFleetOfEveryGeneratorCanStop) {
  for (const sim::Generator& generator : sim::Generators()) {
    OnManySeeds(MixedOf(std::string(generator.name)), [&](const Scenario& scenario) {
      for (const VehicleOptions& own : scenario.vehicles) {
        EXPECT_TRUE(CanStopForStanding(own, scenario.sonar.tier)) << generator.name;
        EXPECT_LE(own.profile.body_radius_m, generator.most_radius_m) << generator.name;
        for (const VehicleOptions& peer : scenario.vehicles) {
          EXPECT_TRUE(SumOf(own, peer, 0).ComesOut()) << generator.name;
        }
      }
    });
  }
}

TEST(FleetDraw, FixesAndWheelErrorsLeaveTheRobotsAsTheyAreDrawn) {
  CaseOptions options = MixedOf("swarm");
  std::vector<Scenario> plain;
  OnManySeeds(options, [&](const Scenario& scenario) { plain.push_back(scenario); });
  options.fleet.pose_fix = {.every_s = 1, .sigma_m = 0.05, .dropout = 0.1};
  options.fleet.most_wheel_error = 0.02;
  std::size_t at = 0;
  double least = 1, most = -1;
  OnManySeeds(options, [&](const Scenario& scenario) {
    for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
      const RobotModel& profile = scenario.vehicles[i].profile;
      const RobotModel& before = plain[at].vehicles[i].profile;
      EXPECT_EQ(profile.body_radius_m, before.body_radius_m);
      EXPECT_EQ(profile.wheel_slip, before.wheel_slip);
      EXPECT_EQ(profile.pose_fix.every_s, 1);
      EXPECT_EQ(profile.pose_limit_m, kUsualPoseLimit_m);
      EXPECT_FALSE(before.pose_fix.Fitted() || before.wheel_error.Any());
      least = std::min({least, profile.wheel_error.diameter, profile.wheel_error.axle});
      most = std::max({most, profile.wheel_error.diameter, profile.wheel_error.axle});
    }
    ++at;
  });
  EXPECT_NEAR(least, -0.02, 0.001);
  EXPECT_NEAR(most, 0.02, 0.001);
}

TEST(FleetDraw, ASensorOfThePositionIsDrawnForAllVehiclesOfASeed) {
  CaseOptions options = MixedOf("swarm");
  options.fleet.draws_pose_fix = true;
  double rarest_s = 0, finest_m = 1, coarsest_m = 0, most_dropout = 0;
  OnManySeeds(options, [&](const Scenario& scenario) {
    const PoseFixModel& first = scenario.vehicles.front().profile.pose_fix;
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      const PoseFixModel& fix = vehicle.profile.pose_fix;
      EXPECT_TRUE(fix.Fitted());
      EXPECT_EQ(fix.every_s, first.every_s);
      EXPECT_EQ(vehicle.profile.pose_limit_m, kUsualPoseLimit_m);
    }
    rarest_s = std::max(rarest_s, first.every_s);
    finest_m = std::min(finest_m, first.sigma_m);
    coarsest_m = std::max(coarsest_m, first.sigma_m);
    most_dropout = std::max(most_dropout, first.dropout);
  });
  EXPECT_GT(rarest_s, 1.5);
  EXPECT_LT(finest_m, 0.03);
  EXPECT_GT(coarsest_m, 0.08);
  EXPECT_GT(most_dropout, 0.25);
}

// The share of the seeds that have both; in the others no vehicle has either.
TEST(FleetDraw, HalfOfTheSeedsHaveWheelErrorsAndTheSensor) {
  CaseOptions options = MixedOf("swarm");
  options.fleet.draws_pose_fix = true;
  options.fleet.most_wheel_error = 0.02;
  options.fleet.pose_keeping_share = 0.5;
  int with = 0;
  OnManySeeds(options, [&](const Scenario& scenario) {
    const bool first = scenario.vehicles.front().profile.pose_fix.Fitted();
    with += first ? 1 : 0;
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      EXPECT_EQ(vehicle.profile.pose_fix.Fitted(), first);
      EXPECT_EQ(vehicle.profile.wheel_error.Any(), first);
    }
  });
  EXPECT_GT(with, 10);
  EXPECT_LT(with, 30);
}

TEST(FleetDraw, DrawsAllThereIs) {
  double weakest = 9, fastest = 0, slowest = 9, largest = 0, most_slip = 0, turns_least = 9;
  std::set<BodyShape> shapes;
  std::set<SonarTier> tiers;
  OnManySeeds(MixedOf("swarm"), [&](const Scenario& scenario) {
    tiers.insert(scenario.sonar.tier);
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      shapes.insert(vehicle.profile.shape);
      weakest = std::min(weakest, vehicle.profile.deceleration_m_s2);
      fastest = std::max(fastest, vehicle.cruise_m_s);
      slowest = std::min(slowest, vehicle.cruise_m_s);
      largest = std::max(largest, vehicle.profile.body_radius_m);
      most_slip = std::max(most_slip, vehicle.profile.wheel_slip);
      turns_least = std::min(turns_least, vehicle.profile.max_turn_rad_s);
      EXPECT_EQ(vehicle.sonar_noise > 0, scenario.sonar.tier != SonarTier::kIdeal);
      EXPECT_EQ(vehicle.sonar_refresh.count() > 0, scenario.sonar.tier == SonarTier::kP3dx);
    }
  });
  EXPECT_EQ(shapes.size(), 2U);
  EXPECT_EQ(tiers.size(), 3U);
  EXPECT_LT(weakest, 0.2);
  EXPECT_GT(fastest, 0.9);
  EXPECT_LT(slowest, 0.25);
  EXPECT_GT(largest, 0.4);
  EXPECT_GT(most_slip, 0.015);
  EXPECT_LT(turns_least, 0.7);
}

// A box is represented by the disc that its beacons publish.
TEST(FleetDraw, ABoxHasTheDiscRoundIt) {
  OnManySeeds(MixedOf("swarm"), [](const Scenario& scenario) {
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      if (vehicle.profile.shape != BodyShape::kBox) continue;
      EXPECT_NEAR(Norm(vehicle.profile.box_half_m), vehicle.profile.body_radius_m, 1e-12);
    }
  });
}

TEST(FleetDraw, WhatCouldNotStopIsDrawnAgain) {
  FleetDraw draw({.mixed_robots = true}, 0.45, 0.4, Random(3));  // beacons that come 0.4 s late
  for (int i = 0; i < 200; ++i) {
    VehicleOptions options;
    options.profile = PioneerP3dx();
    draw.Take(&options);
    EXPECT_TRUE(SumOf(options, options, 0.4).ComesOut());
  }
  EXPECT_GT(draw.Refused(), 10U);
}

TEST(FleetDraw, TheDurationIsThatOfTheRobotsDrawn) {
  OnManySeeds(MixedOf("crossing"), [](const Scenario& scenario) {
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      EXPECT_GE(scenario.duration_s, sim::FreeFlowSeconds(vehicle) + 60);
    }
  });
}

// Goldens and campaigns rely on it: without options nothing is drawn, and the places are the same.
TEST(FleetDraw, LeavesTheRestOfASeedAlone) {
  CaseOptions plain = MixedOf("warehouse");
  plain.fleet = {};
  const Scenario stock = CaseMaker(plain).Make(7).scenario;
  const Scenario mixed = CaseMaker(MixedOf("warehouse")).Make(7).scenario;
  const Scenario made = sim::MakeWarehouse({12, 7});
  ASSERT_EQ(stock.vehicles.size(), made.vehicles.size());
  for (std::size_t i = 0; i < made.vehicles.size(); ++i) {
    EXPECT_EQ(stock.vehicles[i].cruise_m_s, made.vehicles[i].cruise_m_s);
    EXPECT_EQ(stock.vehicles[i].profile.deceleration_m_s2, 0.6);
    EXPECT_EQ(mixed.vehicles[i].start_world.position_world.x,
              made.vehicles[i].start_world.position_world.x);
    EXPECT_EQ(mixed.vehicles[i].goal.at_world.y, made.vehicles[i].goal.at_world.y);
  }
}

TEST(FleetDraw, AScenarioThatNamesItsRobotsKeepsThem) {
  EXPECT_THROW(CaseMaker({.scenario = "four_way", .fleet = {.mixed_robots = true}}), InputError);
  const CaseMaker maker({.scenario = "four_way", .fleet = {.tiers = {SonarTier::kP3dx}}});
  const Scenario scenario = maker.Make(1).scenario;
  EXPECT_EQ(scenario.sonar.tier, SonarTier::kP3dx);
  EXPECT_GT(scenario.vehicles[0].sonar_refresh.count(), 0);
}

}  // namespace
}  // namespace giveway::fleetctl

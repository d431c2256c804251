// Vehicles in a world with every tier of ultrasonics, and with radar, lidar and camera switched on:
// no two bodies touch, and all arrive.
#include <gtest/gtest.h>

#include "tests/support/crossing.h"
#include "tests/support/small_fleet.h"

namespace giveway {
namespace {

using test::SmallFleet;

struct Tier {
  const char* name;
  SonarTier tier;
  Nanoseconds refresh;
  double noise;
};

Scenario In(const Tier& tier, Scenario scenario, std::uint32_t seed) {
  scenario.sonar.tier = tier.tier;
  scenario.seed = seed;
  for (VehicleOptions& options : scenario.vehicles) {
    options.sonar_refresh = tier.refresh;
    options.sonar_noise = tier.noise;
  }
  return scenario;
}

class EveryTier : public testing::TestWithParam<Tier> {};

TEST_P(EveryTier, TwoCrossWithoutContact) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const double second = 0.25 + 0.01 * seed;
    const Scenario scenario =
        In(GetParam(), test::Crossing(Behaviour::kCooperative, 0.35, second), seed);
    SmallFleet fleet(scenario);
    while (fleet.Advance()) {
    }
    EXPECT_EQ(fleet.World().Figures().contacts, 0U) << seed;
    EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U) << seed;
    EXPECT_GT(*fleet.World().Figures().min_separation_m, 0.1) << seed;
  }
}

TEST_P(EveryTier, AWallIsNotTouchedAndNotTakenForSomethingThatMoves) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const double cruise = seed % 2 == 0 ? 0.3 : 0.8;
    Scenario scenario =
        test::ScenarioOf({test::VehicleAt(1, Behaviour::kCooperative, cruise, {-4, 0}, 0, 8)});
    scenario.walls = {{{0, -3}, {0, 3}}};
    scenario.duration_s = 25;
    SmallFleet fleet(In(GetParam(), scenario, seed));
    int deaf = 0;
    while (fleet.Advance()) {
      deaf += fleet.OutputsOf(0).command.decision.rule == Rule::kUnidentifiedMotion ? 1 : 0;
    }
    EXPECT_EQ(fleet.World().Figures().contacts, 0U) << seed;
    EXPECT_EQ(deaf, 0) << seed;
    // It did drive up to it.
    EXPECT_GT(fleet.World().Truths()[0].world_from_body.position_world.x, -1.2) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sonar, EveryTier,
    testing::Values(Tier{"Ideal", SonarTier::kIdeal, Nanoseconds{0}, 0},
                    Tier{"Typical", SonarTier::kTypical, Nanoseconds{0}, 0.01},
                    Tier{"P3dx", SonarTier::kP3dx, Nanoseconds{360'000'000}, 0.01},
                    Tier{"Crosstalk", SonarTier::kCrosstalk, Nanoseconds{360'000'000}, 0.01}),
    [](const auto& test) { return std::string(test.param.name); });

struct Fitted {
  const char* name;
  bool radar;
  bool lidar;
  bool camera;
};

class WithSensors : public testing::TestWithParam<Fitted> {};

TEST_P(WithSensors, TwoCrossWithoutContact) {
  for (int i = 0; i < 10; ++i) {
    Scenario scenario = test::Crossing(Behaviour::kCooperative, 0.35, 0.25 + 0.02 * i);
    for (VehicleOptions& options : scenario.vehicles) {
      options.profile.radar = GetParam().radar;
      options.profile.lidar = GetParam().lidar;
      options.profile.camera = GetParam().camera;
    }
    SmallFleet fleet(scenario);
    while (fleet.Advance()) {
    }
    EXPECT_EQ(fleet.World().Figures().contacts, 0U) << i;
    EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U) << i;
  }
}

// With the ultrasonics switched off nothing else stops it.
TEST_P(WithSensors, AWallAheadIsAnObstacleByItsPlace) {
  Scenario scenario =
      test::ScenarioOf({test::VehicleAt(1, Behaviour::kCooperative, 0.8, {-4, 0}, 0, 8)});
  scenario.walls = {{{0, -3}, {0, 3}}};
  scenario.duration_s = 25;
  scenario.vehicles[0].profile.radar = GetParam().radar;
  scenario.vehicles[0].profile.lidar = GetParam().lidar;
  scenario.vehicles[0].profile.camera = GetParam().camera;
  for (SensorMount& mount : scenario.vehicles[0].profile.sonar) mount.enabled = false;
  SmallFleet fleet(scenario);
  bool object = false;
  while (fleet.Advance()) object |= fleet.OutputsOf(0).command.decision.rule == Rule::kObject;
  EXPECT_TRUE(object);
  EXPECT_EQ(fleet.World().Figures().contacts, 0U);
}

INSTANTIATE_TEST_SUITE_P(Fitted, WithSensors,
                         testing::Values(Fitted{"Radar", true, false, false},
                                         Fitted{"Lidar", false, true, false},
                                         Fitted{"RadarAndCamera", true, false, true},
                                         Fitted{"All", true, true, true}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace giveway

// How a scenario file describes its place, boxes, sensors and spawn places, and what that becomes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;

TEST(Place, TheDefaultsOfSonarAreThoseOfTheTypes) {
  const Scenario scenario = Load(kGoodScenario);
  EXPECT_EQ(scenario.sonar.tier, SonarTier::kIdeal);
  EXPECT_EQ(scenario.vehicles[0].sonar_refresh.count(), 0);
  const SonarModel typical = Load(kGoodScenario + "sonar { tier: typical }").sonar;
  EXPECT_EQ(typical.tier, SonarTier::kTypical);
  EXPECT_EQ(typical.noise, SonarModel{}.noise);
  EXPECT_EQ(typical.max_incidence_rad, SonarModel{}.max_incidence_rad);
}

TEST(Place, TheNamesOfTiersAreThoseOfTheSchema) {
  const auto tier = [](const char* name) {
    return Load(kGoodScenario + "sonar { tier: " + name + " }").sonar.tier;
  };
  EXPECT_EQ(tier("ideal"), SonarTier::kIdeal);
  EXPECT_EQ(tier("typical"), SonarTier::kTypical);
  EXPECT_EQ(tier("p3dx"), SonarTier::kP3dx);
  EXPECT_EQ(tier("crosstalk"), SonarTier::kCrosstalk);
}

TEST(Place, EveryNumberOfTheSonarReachesItsPlace) {
  const SonarModel sonar = Load(kGoodScenario +
                                "sonar { tier: crosstalk blind_m: 0.2 noise: 0.03 "
                                "max_incidence_deg: 20 drop_out: 0.04 slot_ms: 35.5 }")
                               .sonar;
  EXPECT_EQ(sonar.blind_m, 0.2);
  EXPECT_EQ(sonar.noise, 0.03);
  EXPECT_EQ(sonar.max_incidence_rad, Radians(20));
  EXPECT_EQ(sonar.drop_out, 0.04);
  EXPECT_EQ(sonar.slot, std::chrono::microseconds{35'500});
}

// Eight slots in whole ticks, and one slot of listening.
TEST(Place, ARefreshIsARoundOfSlotsInWholeTicksAndOneSlotMore) {
  const auto refresh = [](const std::string& text) {
    return Load(kGoodScenario + text).vehicles[1].sonar_refresh;
  };
  EXPECT_EQ(refresh("sonar { tier: typical }"), milliseconds{0});
  EXPECT_EQ(refresh("sonar { tier: p3dx }"), milliseconds{350 + 40});
  EXPECT_EQ(refresh("sonar { tier: crosstalk }"), milliseconds{350 + 40});
  EXPECT_EQ(refresh("sonar { tier: p3dx slot_ms: 50 }"), milliseconds{400 + 50});
  EXPECT_EQ(refresh("tick_period_ms: 20 sonar { tier: p3dx }"), milliseconds{320 + 40});
}

TEST(Place, ABoxForABodyBringsTheDiscThatHoldsIt) {
  const RobotModel profile =
      Load(Edited("id: 1", "id: 1 profile { box { half_length_m: 0.4 half_width_m: 0.3 } }"))
          .vehicles[0]
          .profile;
  EXPECT_EQ(profile.shape, BodyShape::kBox);
  EXPECT_EQ(profile.box_half_m, (Vec2{0.4, 0.3}));
  EXPECT_DOUBLE_EQ(profile.body_radius_m, 0.5);
}

TEST(Place, TheProfileOfAVehicleMayMakeADiscOfTheScenariosBox) {
  const std::string text = Edited("id: 1", "id: 1 profile { body_radius_m: 0.3 }") +
                           "profile { box { half_length_m: 0.4 half_width_m: 0.3 } }";
  const Scenario scenario = Load(text);
  EXPECT_EQ(scenario.vehicles[0].profile.shape, BodyShape::kDisc);
  EXPECT_EQ(scenario.vehicles[0].profile.body_radius_m, 0.3);
  EXPECT_EQ(scenario.vehicles[0].profile.box_half_m, Vec2{});
  EXPECT_EQ(scenario.vehicles[1].profile.shape, BodyShape::kBox);
}

TEST(Place, SlipNoiseAndSensorsReachTheProfile) {
  const std::string text = Edited("id: 1",
                                  "id: 1 profile { wheel_slip: 0.02 encoder_noise: 0.01 "
                                  "sensors { lidar: true camera: true } }") +
                           "profile { sensors { radar: true lidar: false } }";
  const Scenario scenario = Load(text);
  const RobotModel& first = scenario.vehicles[0].profile;
  EXPECT_EQ(first.wheel_slip, 0.02);
  EXPECT_EQ(first.encoder_noise, 0.01);
  EXPECT_TRUE(first.radar && first.lidar && first.camera);
  const RobotModel& second = scenario.vehicles[1].profile;
  EXPECT_EQ(second.wheel_slip, 0);
  EXPECT_TRUE(second.radar);
  EXPECT_FALSE(second.lidar || second.camera);
}

TEST(Place, AnObstacleStandsWhereItIsWritten) {
  const Scenario scenario = Load(kGoodScenario +
                                 "obstacle { disc_radius_m: 0.3 start { x_m: 3 y_m: -2 } }"
                                 "obstacle { box { half_length_m: 0.4 half_width_m: 0.3 } "
                                 "start { x_m: -3 y_m: -2 heading_deg: 90 } }");
  ASSERT_EQ(scenario.obstacles.size(), 2U);
  EXPECT_EQ(scenario.obstacles[0].shape, BodyShape::kDisc);
  EXPECT_EQ(scenario.obstacles[0].radius_m, 0.3);
  EXPECT_EQ(scenario.obstacles[0].start_world, (Pose{{3, -2}, 0}));
  EXPECT_TRUE(scenario.obstacles[0].waypoints_world.empty());
  EXPECT_EQ(scenario.obstacles[1].shape, BodyShape::kBox);
  EXPECT_EQ(scenario.obstacles[1].box_half_m, (Vec2{0.4, 0.3}));
  EXPECT_DOUBLE_EQ(scenario.obstacles[1].radius_m, 0.5);
  EXPECT_EQ(scenario.obstacles[1].start_world, (Pose{{-3, -2}, kPi / 2}));
}

TEST(Place, AMovingObstacleKnowsItsWay) {
  const Scenario scenario =
      Load(kGoodScenario +
           "obstacle { disc_radius_m: 0.3 start { x_m: 3 y_m: -2 } waypoint { x_m: 4 y_m: -2 } "
           "waypoint { x_m: 4 y_m: -3 } loop: true speed_m_s: 0.7 }");
  EXPECT_THAT(scenario.obstacles[0].waypoints_world, ElementsAre(Vec2{4, -2}, Vec2{4, -3}));
  EXPECT_TRUE(scenario.obstacles[0].loop);
  EXPECT_EQ(scenario.obstacles[0].speed_m_s, 0.7);
}

TEST(Place, ADoorKnowsItsJambsAndTimes) {
  const Scenario scenario =
      Load(kGoodScenario +
           "door { from { x_m: 5 y_m: 3 } to { x_m: 6 y_m: 3 } closed_s: 1 open_s: 2 move_s: 3 "
           "offset_s: 4 } door { from { x_m: 8 y_m: 3 } to { x_m: 9 y_m: 3 } }");
  ASSERT_EQ(scenario.doors.size(), 2U);
  const Door& door = scenario.doors[0];
  EXPECT_EQ(door.from_world, (Vec2{5, 3}));
  EXPECT_EQ(door.to_world, (Vec2{6, 3}));
  EXPECT_EQ(door.closed_s, 1);
  EXPECT_EQ(door.open_s, 2);
  EXPECT_EQ(door.move_s, 3);
  EXPECT_EQ(door.offset_s, 4);
  EXPECT_EQ(scenario.doors[1].move_s, Door{}.move_s);
}

TEST(Place, AOneLaneSectionIsKnownToEveryVehicle) {
  const Scenario scenario = Load(kGoodScenario +
                                 "emission_radius_m: 20 one_lane { from { x_m: 1 y_m: 2 } "
                                 "to { x_m: 3 y_m: 4 } width_m: 0.9 }");
  ASSERT_EQ(scenario.one_lanes.size(), 1U);
  EXPECT_EQ(scenario.one_lanes[0].from_world, (Vec2{1, 2}));
  EXPECT_EQ(scenario.one_lanes[0].to_world, (Vec2{3, 4}));
  EXPECT_EQ(scenario.one_lanes[0].width_m, 0.9);
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    ASSERT_EQ(vehicle.one_lanes.size(), 1U);
    EXPECT_EQ(vehicle.one_lanes[0].to_world, (Vec2{3, 4}));
  }
}

TEST(Place, SignalsComeSortedWithTheirPlans) {
  const std::string line = "line { from { x_m: -1 y_m: -1 } to { x_m: -1 y_m: 1 } } heading_deg: 0";
  const Scenario scenario =
      Load(kGoodScenario + "signal { id: 9 " + line + " }" + "signal { id: 4 group: 2 " + line +
           " green_s: 5 yellow_s: 2 red_s: 7 offset_s: 3 } fault { dark: 9 at_s: 1 } "
           "fault { silent: 4 at_s: 2 }");
  ASSERT_EQ(scenario.signals.size(), 2U);
  const SignalPlan& signal = scenario.signals[0];
  EXPECT_EQ(signal.id, SignalId{4});
  EXPECT_EQ(signal.group, 2U);
  EXPECT_EQ(signal.line_from_world, (Vec2{-1, -1}));
  EXPECT_EQ(signal.line_to_world, (Vec2{-1, 1}));
  EXPECT_EQ(signal.travel_rad, 0);
  EXPECT_EQ(signal.green_s, 5);
  EXPECT_EQ(signal.yellow_s, 2);
  EXPECT_EQ(signal.red_s, 7);
  EXPECT_EQ(signal.offset_s, 3);
  EXPECT_EQ(scenario.signals[1].id, SignalId{9});
  EXPECT_EQ(scenario.signals[1].green_s, SignalPlan{}.green_s);
  ASSERT_EQ(scenario.faults.size(), 3U);
  EXPECT_EQ(scenario.faults[0].kind, FaultKind::kKill);
  EXPECT_EQ(scenario.faults[1].kind, FaultKind::kSignalDark);
  EXPECT_EQ(scenario.faults[1].signal, SignalId{9});
  EXPECT_EQ(scenario.faults[1].at_s, 1);
  EXPECT_EQ(scenario.faults[2].kind, FaultKind::kSignalSilent);
  EXPECT_EQ(scenario.faults[2].vehicle, kNoVehicle);
}

const std::string kSpawn =
    "spawn { start { x_m: -8 y_m: 0 heading_deg: 0 } cruise_m_s: 0.2 goal { x_m: 4 y_m: 0 } "
    "behaviour: stock_avoid profile { body_radius_m: 0.3 } }";

TEST(Place, ASpawnPlaceIsAVehicleWithoutAnId) {
  const Scenario scenario = Load(kGoodScenario + kSpawn + "sonar { tier: p3dx }");
  ASSERT_EQ(scenario.spawns.size(), 1U);
  const VehicleOptions& spawn = scenario.spawns[0];
  EXPECT_EQ(spawn.id, kNoVehicle);
  EXPECT_EQ(spawn.start_world, (Pose{{-8, 0}, 0}));
  EXPECT_EQ(spawn.cruise_m_s, 0.2);
  EXPECT_TRUE(spawn.goal.set);
  EXPECT_EQ(spawn.behaviour, Behaviour::kStockAvoid);
  EXPECT_EQ(spawn.braitenberg.left, StockWeights().left);
  EXPECT_EQ(spawn.profile.body_radius_m, 0.3);
  EXPECT_EQ(spawn.sonar_refresh, milliseconds{390});
  EXPECT_EQ(scenario.start_with, 2U);
}

TEST(Place, AFleetWithoutNamedVehiclesStartsWithTheFirst) {
  const Scenario scenario = Load("name: \"open\" expect {}" + kSpawn);
  EXPECT_TRUE(scenario.vehicles.empty());
  EXPECT_EQ(scenario.start_with, 1U);
  EXPECT_EQ(Load(kGoodScenario + kSpawn + "start_with: 3").start_with, 3U);
}

TEST(Place, AClosedFleetStartsWithNobodyInParticular) {
  EXPECT_EQ(Load(kGoodScenario).start_with, 0U);
}

// Vehicles have ids 1 and 2, so the first to join gets 3.
TEST(Place, AnExpectationMayNameTheIdsTheWorldGives) {
  const auto text = [](const char* ids) {
    return Edited("arrived: [1]", std::string("arrived: [") + ids + "]") + kSpawn;
  };
  EXPECT_THAT(Load(text("1, 3")).expect.arrived, ElementsAre(VehicleId{1}, VehicleId{3}));
  EXPECT_EQ(ProblemsOf(text("1, 4")).size(), 1U);
}

TEST(Place, WhoHaltsOrArrivesMayBeLeftOpen) {
  const Expectation expect =
      Load(Edited("arrived: [1]", "any_arrived: true any_halted: true")).expect;
  EXPECT_TRUE(expect.any_arrived);
  EXPECT_TRUE(expect.any_halted);
  EXPECT_FALSE(Load(kGoodScenario).expect.any_arrived);
}

TEST(Place, TheSeedLeavesAllButTheVehiclesWhereTheyAre) {
  const std::string text = kGoodScenario + kSpawn +
                           "obstacle { disc_radius_m: 0.3 start { x_m: 3 y_m: -2 } } "
                           "door { from { x_m: 5 y_m: 3 } to { x_m: 6 y_m: 3 } }";
  ScenarioOverrides overrides;
  overrides.seed = 7;
  const Scenario still = Load(text);
  const Scenario moved = Load(text, overrides);
  EXPECT_NE(moved.vehicles[0].start_world, still.vehicles[0].start_world);
  EXPECT_EQ(moved.vehicles[0].start_world, Load(kGoodScenario, overrides).vehicles[0].start_world);
  EXPECT_EQ(moved.spawns[0].start_world, still.spawns[0].start_world);
  EXPECT_EQ(moved.spawns[0].cruise_m_s, still.spawns[0].cruise_m_s);
  EXPECT_EQ(moved.obstacles[0].start_world, still.obstacles[0].start_world);
  EXPECT_EQ(moved.doors[0].from_world, still.doors[0].from_world);
  EXPECT_EQ(moved.doors[0].offset_s, still.doors[0].offset_s);
}

}  // namespace
}  // namespace giveway

// A scenario that is written reads back as the same.
#include "services/config/writing/scenario_write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>

#include "services/config/config_dir.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/config/writing/scenario_rounding.h"
#include "services/types/math/math.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

Scenario AnyScenario() {
  Scenario scenario;
  scenario.name = "any";
  scenario.duration_s = 12.3456;
  scenario.walls = {{{0.12345, 5}, {6, 7.00049}}};
  scenario.one_lanes = {{{1.00049, 2}, {3, 4}, 0.98765}};
  scenario.expect.any_halted = true;
  scenario.expect.halted_for = Rule::kPeerLost;
  scenario.expect.arrived = {VehicleId{3}};
  VehicleOptions& vehicle = scenario.vehicles.emplace_back();
  vehicle.id = VehicleId{3};
  vehicle.profile = PioneerP3dx();
  vehicle.behaviour = Behaviour::kLecturePrinted;
  vehicle.distance_metric = DistanceMetric::kManhattan;
  vehicle.braitenberg = LectureWeights();
  vehicle.cruise_m_s = 0.333333;
  vehicle.start_world = {.position_world = {-1.23456, 2.34567}, .heading_rad = Radians(123.45678)};
  vehicle.goal = {.set = true, .at_world = {8.7654321, 9}, .radius_m = 0.2};
  vehicle.route.waypoints_world[0] = {1.00001, 2};
  vehicle.route.count = 1;
  scenario.faults = {{.kind = FaultKind::kKill, .vehicle = VehicleId{3}, .at_s = 4}};
  return scenario;
}

TEST(WrittenScenario, ReadsBackBitForBitOnceItIsRounded) {
  const Scenario written = Rounded(AnyScenario());
  const Scenario read = Load(WriteScenario(written, "a comment\nof two lines"));
  EXPECT_EQ(read.name, "any");
  EXPECT_EQ(read.duration_s, written.duration_s);
  ASSERT_EQ(read.vehicles.size(), 1U);
  const VehicleOptions& vehicle = read.vehicles[0];
  EXPECT_EQ(vehicle.id, VehicleId{3});
  EXPECT_EQ(vehicle.behaviour, Behaviour::kLecturePrinted);
  EXPECT_EQ(vehicle.distance_metric, DistanceMetric::kManhattan);
  EXPECT_EQ(vehicle.start_world, written.vehicles[0].start_world);
  EXPECT_EQ(vehicle.cruise_m_s, 0.333);
  EXPECT_EQ(vehicle.goal.at_world, (Vec2{8.765, 9}));
  EXPECT_EQ(vehicle.goal.radius_m, 0.2);
  ASSERT_EQ(vehicle.route.count, 1U);
  EXPECT_EQ(vehicle.route.waypoints_world[0], (Vec2{1, 2}));
  ASSERT_EQ(read.walls.size(), 1U);
  EXPECT_EQ(read.walls[0].to_world, (Vec2{6, 7}));
  ASSERT_EQ(read.one_lanes.size(), 1U);
  EXPECT_EQ(read.one_lanes[0].from_world, (Vec2{1, 2}));
  EXPECT_EQ(read.one_lanes[0].width_m, 0.988);
  ASSERT_EQ(written.vehicles[0].one_lanes.size(), 1U);
  EXPECT_EQ(vehicle.one_lanes[0].width_m, written.vehicles[0].one_lanes[0].width_m);
  ASSERT_EQ(read.faults.size(), 1U);
  EXPECT_EQ(read.faults[0].at_s, 4);
  EXPECT_TRUE(read.expect.any_halted);
  EXPECT_EQ(read.expect.halted_for, Rule::kPeerLost);
  EXPECT_EQ(read.expect.arrived, std::vector{VehicleId{3}});
}

TEST(WrittenScenario, BeginsWithItsComment) {
  EXPECT_THAT(WriteScenario(AnyScenario(), "why\nand how"),
              testing::StartsWith("# why\n# and how\nname: \"any\"\n"));
}

// Each of these is one number more or less that a file may hold.
using Change = void (*)(Scenario*);
constexpr Change kChanges[] = {
    [](Scenario* s) { s->description = "of what"; },
    [](Scenario* s) { s->area = "yard"; },
    [](Scenario* s) { s->start_timeout_s = 20; },
    [](Scenario* s) { s->sonar = {.tier = SonarTier::kTypical}; },
    [](Scenario* s) { s->sonar = {.tier = SonarTier::kTypical, .blind_m = 0.2}; },
    [](Scenario* s) { s->sonar = {.tier = SonarTier::kTypical, .noise = 0.02}; },
    [](Scenario* s) { s->sonar = {.tier = SonarTier::kTypical, .max_incidence_rad = Radians(30)}; },
    [](Scenario* s) { s->sonar = {.tier = SonarTier::kTypical, .drop_out = 0.02}; },
    [](Scenario* s) { s->sonar = {.tier = SonarTier::kP3dx, .slot = Nanoseconds{50'000'000}}; },
    [](Scenario* s) {
      s->obstacles = {{.radius_m = 0.3, .start_world = {{5, -5}, 0}}};
    },
    [](Scenario* s) {
      s->obstacles = {{.shape = BodyShape::kBox,
                       .radius_m = 0.5,
                       .box_half_m = {0.4, 0.3},
                       .start_world = {{5, -5}, Radians(30)},
                       .waypoints_world = {{6, -5}, {6, -6}},
                       .loop = true,
                       .speed_m_s = 0.4}};
    },
    [](Scenario* s) {
      s->doors = {{.from_world = {20, 0},
                   .to_world = {21, 0},
                   .closed_s = 1,
                   .open_s = 2,
                   .move_s = 3,
                   .offset_s = 4}};
    },
    [](Scenario* s) {
      s->signals = {{.id = SignalId{7},
                     .group = 2,
                     .line_from_world = {20, 0},
                     .line_to_world = {21, 0},
                     .travel_rad = Radians(80),
                     .green_s = 4,
                     .yellow_s = 2,
                     .red_s = 5,
                     .offset_s = 1}};
      s->faults = {{.kind = FaultKind::kSignalDark, .at_s = 3, .signal = SignalId{7}},
                   {.kind = FaultKind::kSignalSilent, .at_s = 4, .signal = SignalId{7}}};
    },
    [](Scenario* s) {
      s->spawns = s->vehicles;
      s->spawns[0].id = kNoVehicle;
      s->spawns[0].start_world.position_world = {30, 30};
      s->start_with = 2;
    },
    [](Scenario* s) { s->expect.parted = true; },
    [](Scenario* s) { s->expect.min_separation_m = 0.5; },
    [](Scenario* s) { s->expect.time_to_clear_s = 50; },
    [](Scenario* s) { s->vehicles[0].braitenberg.base_rad_s = 1; },
    [](Scenario* s) { s->vehicles[0].braitenberg.near_gate_m = 0.3; },
    [](Scenario* s) { s->vehicles[0].braitenberg.far_gate_m = 0.9; },
    [](Scenario* s) { s->vehicles[0].braitenberg.left[15] = 0.25; },
    [](Scenario* s) { s->vehicles[0].braitenberg.right[0] = 0.25; },
    [](Scenario* s) { s->vehicles[0].profile.body_radius_m = 0.3; },
    [](Scenario* s) {
      RobotModel& robot = s->vehicles[0].profile;
      robot.shape = BodyShape::kBox;
      robot.box_half_m = {0.3, 0.2};
      robot.body_radius_m = Norm(robot.box_half_m);
    },
    [](Scenario* s) { s->vehicles[0].profile.drive.wheel_radius_m = 0.12; },
    [](Scenario* s) { s->vehicles[0].profile.drive.axle_m = 0.4; },
    [](Scenario* s) { s->vehicles[0].profile.max_speed_m_s = 1.2; },
    [](Scenario* s) { s->vehicles[0].profile.max_turn_rad_s = 1.5; },
    [](Scenario* s) { s->vehicles[0].profile.acceleration_m_s2 = 0.4; },
    [](Scenario* s) { s->vehicles[0].profile.deceleration_m_s2 = 0.5; },
    [](Scenario* s) { s->vehicles[0].profile.wheel_slip = 0.012345678; },
    [](Scenario* s) { s->vehicles[0].profile.encoder_noise = 0.012345678; },
    [](Scenario* s) { s->vehicles[0].profile.radar = true; },
    [](Scenario* s) { s->vehicles[0].profile.lidar = true; },
    [](Scenario* s) { s->vehicles[0].profile.camera = true; },
    [](Scenario* s) {
      RobotModel& robot = s->vehicles[0].profile;
      robot.pose_fix.every_s = 0.5;
      robot.pose_fix.sigma_m = 0.05;
      robot.pose_fix.dropout = 0.1;
      robot.pose_fix.sigma_heading_rad = Radians(3);
      robot.pose_limit_m = 0.2;
    },
    [](Scenario* s) { s->vehicles[0].profile.wheel_error = {.diameter = 0.01, .axle = -0.02}; },
    [](Scenario* s) {
      for (std::size_t i = kSensorCount / 2; i < kSensorCount; ++i) {
        s->vehicles[0].profile.sonar[i].enabled = true;
      }
    },
    [](Scenario* s) { s->vehicles[0].route.loop = true; },
    [](Scenario* s) { s->impairment.seed = 4; },
};

TEST(WrittenScenario, HoldsWhateverAFileMayHold) {
  Scenario plain = Rounded(AnyScenario());
  plain.vehicles[0].behaviour = Behaviour::kLectureAvoid;
  plain.vehicles[0].emission_radius_m = 8;  // far enough for every robot below
  plain.impairment.rules = {{.loss = 0.1}};
  const std::string before = WriteScenario(plain, "");
  for (std::size_t i = 0; i < std::size(kChanges); ++i) {
    Scenario changed = plain;
    kChanges[i](&changed);
    if (!changed.spawns.empty() || changed.vehicles[0].route.loop) changed.expect.arrived = {};
    const std::string text = WriteScenario(changed, "");
    EXPECT_NE(text, before) << "change " << i;
    EXPECT_EQ(WriteScenario(ReadBack(changed), ""), text) << "change " << i;
  }
}

// Every shipped one, with walls, doors, lights, spawn places, realistic ultrasonics, other robots.
TEST(WrittenScenario, OfAShippedOneReadsBackAsTheSame) {
  const std::vector<std::string> names = ShippedNames("scenarios");
  EXPECT_GT(names.size(), 20U);
  for (const std::string& name : names) {
    const Scenario scenario = LoadScenario(name, {.seed = 0});
    EXPECT_EQ(WriteScenario(ReadBack(scenario), ""), WriteScenario(scenario, "")) << name;
  }
}

TEST(WrittenScenario, ThatBreaksARuleOfFilesIsRefusedWithTheRule) {
  Scenario broken = AnyScenario();
  broken.vehicles[0].cruise_m_s = 2;
  try {
    ReadBack(broken);
    ADD_FAILURE() << "a cruise speed above the top speed is read";
  } catch (const InputError& error) {
    ASSERT_FALSE(error.Problems().empty());
    EXPECT_EQ(error.Problems()[0].field, "vehicle[0].cruise_m_s");
  }
}

TEST(RoundedScenario, IsOneThatPeopleRead) {
  Scenario scenario = AnyScenario();
  RobotModel& robot = scenario.vehicles[0].profile;
  robot.shape = BodyShape::kBox;
  robot.box_half_m = {0.31234567, 0.2};
  robot.max_turn_rad_s = 1.23456789;
  robot.max_speed_m_s = 0.33321;
  scenario.vehicles[0].cruise_m_s = 0.3332;
  scenario.obstacles = {{.radius_m = 0.30049, .start_world = {{1.00049, 2}, 1}}};
  const Scenario rounded = Rounded(scenario);
  EXPECT_EQ(rounded.vehicles[0].profile.box_half_m, (Vec2{0.312, 0.2}));
  EXPECT_EQ(rounded.vehicles[0].profile.body_radius_m, Norm({0.312, 0.2}));
  EXPECT_EQ(rounded.vehicles[0].profile.max_turn_rad_s, 1.235);
  EXPECT_EQ(rounded.vehicles[0].cruise_m_s, 0.333);
  EXPECT_EQ(rounded.obstacles[0].radius_m, 0.3);
  EXPECT_EQ(rounded.obstacles[0].start_world.position_world, (Vec2{1, 2}));
}

}  // namespace
}  // namespace giveway

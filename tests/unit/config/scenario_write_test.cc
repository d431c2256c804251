// A scenario that is written reads back as the same.
#include "services/config/writing/scenario_write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  const Scenario written = RoundedAsWritten(AnyScenario());
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

TEST(WrittenScenario, IsRefusedWhereItWouldLeaveSomethingOut) {
  Scenario with_door = AnyScenario();
  with_door.doors.emplace_back();
  EXPECT_THROW(WriteScenario(with_door, ""), InputError);
  Scenario with_slip = AnyScenario();
  with_slip.vehicles[0].profile.wheel_slip = 0.1;
  EXPECT_THROW(WriteScenario(with_slip, ""), InputError);
}

}  // namespace
}  // namespace giveway

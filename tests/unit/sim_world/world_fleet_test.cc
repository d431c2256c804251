// Vehicles that join and leave, checkpoints, and what other sensors receive.
#include <gtest/gtest.h>

#include <algorithm>

#include "services/types/math/math.h"
#include "sim_world/world.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

VehicleOptions BoxVehicle(std::uint32_t id, Pose start, Vec2 half_m) {
  VehicleOptions options = VehicleAt(id, start);
  options.profile.shape = BodyShape::kBox;
  options.profile.box_half_m = half_m;
  options.profile.body_radius_m = Norm(half_m);
  return options;
}

std::uint64_t HashOf(const World& world) {
  StateHash hash;
  world.AddTo(&hash);
  return hash.Value();
}

TEST(WorldFleet, WhoeverJoinsIsSortedByIdInAnyOrder) {
  World world(ScenarioOf({VehicleAt(5, {})}), kEpoch);
  for (const std::uint32_t id : {9U, 2U, 7U, 1U}) world.Join(VehicleAt(id, {{2.0 * id, 0}, 0}));
  world.Join(VehicleId{5});
  ASSERT_EQ(world.Bodies().size(), 5U);
  EXPECT_TRUE(std::ranges::is_sorted(world.Bodies(), {}, &Body::vehicle));
  world.Advance(true);
  for (const Body& body : world.Bodies()) {
    EXPECT_TRUE(body.present);
    EXPECT_EQ(body.sonar.readings[0].kind, Echo::kClear) << Number(body.vehicle);
  }
}

// A vehicle that joins in the middle shifts the indices of the others: contacts, motions and
// readings must follow.
TEST(WorldFleet, JoiningDuringARunDisturbsNobody) {
  const auto scenario = ScenarioOf({VehicleAt(2, {}), VehicleAt(9, {{0.6, 0}, kPi})});
  World world(scenario, kEpoch);
  world.Join(VehicleId{2});
  world.Join(VehicleId{9});
  DriveAll(&world, 4, 4, 60);
  EXPECT_EQ(world.Contacts(), 1U);
  world.Join(VehicleAt(1, {{0, 5}, 0}));
  world.Join(VehicleAt(4, {{0, 8}, 0}));
  DriveAll(&world, 4, 4, 60);
  EXPECT_EQ(world.Contacts(), 1U);
  EXPECT_EQ(world.Bodies()[1].vehicle, VehicleId{2});
  EXPECT_EQ(world.Bodies()[1].sonar.readings[3].kind, Echo::kEcho);
  EXPECT_GT(world.Bodies()[0].world_from_body.position_world.x, 0.5);
}

TEST(WorldFleet, JoiningDoesNotBringBackTheRemoved) {
  World world(ScenarioOf({VehicleAt(3, {{1, 0}, 0}), VehicleAt(5, {})}), kEpoch);
  world.Join(VehicleId{3});
  world.Join(VehicleId{5});
  world.Advance(true);
  world.Remove(VehicleId{3});
  world.Join(VehicleAt(1, {{0, 5}, 0}));
  DriveAll(&world, 4, 4, 100);
  EXPECT_EQ(world.Contacts(), 0U);
  EXPECT_GT(world.Bodies()[2].world_from_body.position_world.x, 1);
}

TEST(WorldFleet, ASecondJoinStartsAfresh) {
  World world(ScenarioOf({VehicleAt(1, {{1, 2}, 0.5})}), kEpoch);
  world.Join(VehicleId{1});
  DriveAll(&world, 4, 5, 40);
  world.Remove(VehicleId{1});
  world.Advance(true);
  world.Join(VehicleId{1});
  const Body& body = world.Bodies()[0];
  EXPECT_EQ(body.world_from_body, (Pose{{1, 2}, 0.5}));
  EXPECT_EQ(body.wheels, WheelSpeeds{});
  EXPECT_EQ(body.command.tick, kNoTick);
  world.Advance(true);
  EXPECT_EQ(body.world_from_body, (Pose{{1, 2}, 0.5}));
}

TEST(WorldFleet, ASecondJoinMayBringAnotherBody) {
  World world(ScenarioOf({VehicleAt(1, {})}), kEpoch);
  world.Join(VehicleId{1});
  world.Remove(VehicleId{1});
  world.Join(BoxVehicle(1, {{3, 0}, 0}, {0.4, 0.2}));
  EXPECT_EQ(world.Bodies().size(), 1U);
  EXPECT_TRUE(world.IsFree(VehicleAt(2, {{3, 0.46}, 0})));
  EXPECT_FALSE(world.IsFree(VehicleAt(2, {{3.6, 0}, 0})));
}

TEST(WorldFleet, APlaceIsFreeWhereNothingTouches) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {})});
  scenario.walls = {{{3, -1}, {3, 1}}};
  scenario.obstacles = {
      {.shape = BodyShape::kBox, .box_half_m = {0.5, 0.1}, .start_world = {{-3, 0}, 0}}};
  scenario.doors = {{.from_world = {-1, 3}, .to_world = {1, 3}}};
  World world(scenario, kEpoch);
  const auto is_free = [&](Vec2 at) { return world.IsFree(VehicleAt(2, {at, 0})); };
  EXPECT_TRUE(is_free({0.4, 0}));  // no vehicle is there yet
  world.Join(VehicleId{1});
  EXPECT_FALSE(is_free({0.4, 0}));
  EXPECT_FALSE(is_free({0.5, 0}));
  EXPECT_TRUE(is_free({0.51, 0}));
  EXPECT_FALSE(is_free({2.8, 0.5}));
  EXPECT_TRUE(is_free({2.8, 1.5}));
  EXPECT_FALSE(is_free({-3.7, 0}));
  EXPECT_TRUE(is_free({-3, 0.4}));
  EXPECT_FALSE(is_free({0.5, 3.1}));
  EXPECT_TRUE(is_free({1.5, 3.1}));
  EXPECT_TRUE(world.IsFree(VehicleAt(1, {})));  // its own place
}

// Regression: a vehicle appeared right in front of another that drove, which hit it.
TEST(WorldFleet, APlaceIsNotFreeBeforeAVehicleThatCannotStopForIt) {
  World world = WorldOf(ScenarioOf({VehicleAt(1, {})}));
  DriveAll(&world, 4, 4, 60);
  const double front_m = world.Bodies()[0].world_from_body.position_world.x + 0.25;
  const auto is_free = [&](Vec2 ahead) {
    return world.IsFree(VehicleAt(2, {{front_m + ahead.x, ahead.y}, 0}));
  };
  // 0.39 m/s: the watchdog's three ticks, and 0.39^2 / (2 * 0.6) = 0.13 m.
  EXPECT_FALSE(is_free({0.25 + 0.06 + 0.13, 0}));
  EXPECT_TRUE(is_free({0.25 + 0.3, 0}));
  EXPECT_TRUE(is_free({-0.76, 0})) << "behind it";
  EXPECT_TRUE(is_free({0, 0.51})) << "next to it";
  DriveAll(&world, 0, 0, 30);
  EXPECT_TRUE(world.IsFree(
      VehicleAt(2, {{world.Bodies()[0].world_from_body.position_world.x + 0.51, 0}, 0})));
}

TEST(WorldFleet, APlaceIsNotFreeBeforeACartUnlessItStandsWithTheRun) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 5}, 0})});
  scenario.obstacles = {{.radius_m = 0.25,
                         .start_world = {{0, 0}, 0},
                         .waypoints_world = {{4, 0}},
                         .speed_m_s = 0.5}};
  World world = WorldOf(scenario);
  world.Advance(false);
  const VehicleOptions before_it = VehicleAt(2, {{1, 0}, 0});
  EXPECT_TRUE(world.IsFree(before_it)) << "no run ever starts where a cart keeps a vehicle out";
  world.Advance(true);
  EXPECT_FALSE(world.IsFree(before_it));
  EXPECT_TRUE(world.IsFree(VehicleAt(2, {{1, 0.6}, 0})));
  for (int i = 0; i < 70; ++i) world.Advance(true);
  EXPECT_TRUE(world.IsFree(before_it)) << "it has passed";
}

Scenario Busy() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {}), BoxVehicle(2, {{1, 0.3}, 2}, {0.3, 0.2})});
  scenario.vehicles[0].profile.wheel_slip = 0.1;
  scenario.obstacles = {
      {.start_world = {{-2, 0}, 0}, .waypoints_world = {{3, 0}}, .speed_m_s = 0.5}};
  scenario.doors = {{.from_world = {1, 2}, .to_world = {1, -1}, .closed_s = 0.5}};
  return scenario;
}

TEST(WorldFleet, ARestoredWorldGoesOnAsTheFirstDid) {
  World first(Busy(), kEpoch);
  for (const Body& body : first.Bodies()) first.Join(body.vehicle);
  DriveAll(&first, 4, 3, 45);
  World second(Busy(), kEpoch);
  ASSERT_TRUE(second.Restore(first.Save()));
  EXPECT_EQ(HashOf(second), HashOf(first));
  EXPECT_EQ(second.Now(), first.Now());
  first.Remove(VehicleId{2});  // commands are not kept, contacts are not remembered
  second.Remove(VehicleId{2});
  DriveAll(&first, 4, 3, 100);
  DriveAll(&second, 4, 3, 100);
  EXPECT_EQ(second.Obstacles()[0].State().position_world,
            first.Obstacles()[0].State().position_world);
  EXPECT_EQ(second.Doors()[0].Opening(), first.Doors()[0].Opening());
  EXPECT_EQ(second.Bodies()[0].world_from_body, first.Bodies()[0].world_from_body);
}

TEST(WorldFleet, ACheckpointOfAnotherScenarioIsRefused) {
  World first(Busy(), kEpoch);
  first.Join(VehicleId{1});
  Checkpoint checkpoint = first.Save();
  World other(ScenarioOf({VehicleAt(1, {})}), kEpoch);
  EXPECT_FALSE(other.Restore(checkpoint));
  checkpoint.obstacles.clear();
  checkpoint.door_openings.clear();
  EXPECT_TRUE(other.Restore(checkpoint));
  checkpoint.bodies.push_back({VehicleId{77}, {}, {}});
  EXPECT_FALSE(other.Restore(checkpoint));
}

TEST(WorldFleet, WhatSensorsAreToldOfOwnersIsWhatMoves) {
  World world(Busy(), kEpoch);
  for (const Body& body : world.Bodies()) world.Join(body.vehicle);
  world.Take(Drive(1, Tick{0}, 0, 0));
  DriveAll(&world, 1, 1, 5);
  const OwnerFacts vehicle = world.FactsOf(0);
  EXPECT_EQ(vehicle.seen_class, SeenClass::kVehicle);
  EXPECT_GT(vehicle.velocity_world.x, 0.01);
  const OwnerFacts cart = world.FactsOf(2);
  EXPECT_EQ(cart.seen_class, SeenClass::kCart);
  EXPECT_NEAR(cart.velocity_world.x, 0.5, 1e-9);
  EXPECT_EQ(world.FactsOf(3).seen_class, SeenClass::kFixture);
  EXPECT_EQ(world.SceneNow().Discs().owner.size(), 2U);  // the other vehicle is a box
}

}  // namespace
}  // namespace giveway::sim

#include "sim_world/dynamics/obstacles.h"

#include <gtest/gtest.h>

#include "sim_world/dynamics/doors.h"
#include "sim_world/world.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

Obstacle Cart(Vec2 start, std::vector<Vec2> waypoints, double speed_m_s, bool loop = false) {
  return {.start_world = {start, 0},
          .waypoints_world = std::move(waypoints),
          .loop = loop,
          .speed_m_s = speed_m_s};
}

void Advance(World* world, int ticks) {
  for (int i = 0; i < ticks; ++i) world->Advance(true);
}

Vec2 At(const World& world, std::size_t i = 0) {
  return world.Obstacles()[i].State().position_world;
}

TEST(Course, GoesThereAndBack) {
  const Course course(Cart({0, 0}, {{1, 0}, {1, 2}}, 1));
  EXPECT_EQ(course.At(0.5), (Vec2{0.5, 0}));
  EXPECT_EQ(course.At(2), (Vec2{1, 1}));
  EXPECT_EQ(course.At(4), (Vec2{1, 1}));
  EXPECT_EQ(course.At(5.5), (Vec2{0.5, 0}));
  EXPECT_EQ(course.At(6.5), (Vec2{0.5, 0}));
}

TEST(Course, GoesRound) {
  const Course course(Cart({0, 0}, {{1, 0}, {1, 1}, {0, 1}}, 1, true));
  EXPECT_EQ(course.At(3.5), (Vec2{0, 0.5}));
  EXPECT_EQ(course.At(4.25), (Vec2{0.25, 0}));
}

TEST(Obstacle, StandsUntilTheStartSignalAndThenKeepsItsSpeed) {
  Scenario scenario = ScenarioOf({});
  scenario.obstacles = {Cart({0, 0}, {{10, 0}}, 0.4)};
  World world = WorldOf(scenario);
  for (int i = 0; i < 10; ++i) world.Advance(false);
  EXPECT_EQ(At(world), (Vec2{0, 0}));
  Advance(&world, 100);
  EXPECT_NEAR(At(world).x, 2, 1e-12);
}

TEST(Obstacle, NeverMovesFasterThanItsSpeedRoundBends) {
  Scenario scenario = ScenarioOf({});
  scenario.obstacles = {Cart({0, 0}, {{0.31, 0}, {0.31, 0.13}, {0, 0.2}}, 0.7, true)};
  World world = WorldOf(scenario);
  for (int i = 0; i < 500; ++i) {
    const Vec2 before = At(world);
    world.Advance(true);
    ASSERT_LE(Norm(At(world) - before), 0.7 * kDt_s + 1e-12);
  }
}

// Regression: a tick that turned in its middle ended where it started, and the cart stood for ever.
TEST(Obstacle, TurnsInTheMiddleOfATick) {
  Scenario scenario = ScenarioOf({});
  scenario.obstacles = {Cart({3, 0}, {{4.25, 0}}, 0.4)};
  World world = WorldOf(scenario);
  int stood = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const Vec2 before = At(world);
    Advance(&world, 1);
    stood = At(world) == before ? stood + 1 : 0;
    ASSERT_LE(stood, 1) << tick;
  }
}

TEST(Obstacle, WithoutAWayStands) {
  Scenario scenario = ScenarioOf({});
  scenario.obstacles = {Cart({1, 2}, {}, 1), Cart({5, 2}, {{5, 2}}, 1)};
  World world = WorldOf(scenario);
  Advance(&world, 20);
  EXPECT_EQ(At(world, 0), (Vec2{1, 2}));
  EXPECT_EQ(At(world, 1), (Vec2{5, 2}));
}

TEST(Obstacle, IsHeldUpByAVehicleAndGoesOnWhenItIsGone) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{1.5, 0}, 0})});
  scenario.obstacles = {Cart({0, 0}, {{10, 0}}, 0.5)};
  World world = WorldOf(scenario);
  Advance(&world, 100);
  EXPECT_NEAR(At(world).x, 1, kTouch_m);
  EXPECT_EQ(world.Contacts(), 1U);
  world.Remove(VehicleId{1});
  Advance(&world, 20);
  EXPECT_NEAR(At(world).x, 1.5, 2 * kTouch_m);
}

TEST(Obstacle, MeetingAVehicleIsAContactWithNobodyThatSaysWhat) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0.7, 0}, 0})});
  scenario.obstacles = {Cart({0, 0}, {{10, 0}}, 0.5)};
  World world = WorldOf(scenario);
  while (world.NewContacts().empty()) world.Advance(true);
  const Contact contact = world.NewContacts().front();
  EXPECT_EQ(contact.vehicle, VehicleId{1});
  EXPECT_EQ(contact.other, kNoVehicle);
  EXPECT_EQ(contact.touched, Touched::kObstacle);
  EXPECT_NEAR(contact.other_position_world.x, 0.45, 1e-5);
}

// The cart is faster and pushes, but the vehicle is not held.
TEST(Obstacle, AVehicleMayDriveAwayFromACartThatPushesIt) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0.6, 0}, 0})});
  scenario.obstacles = {Cart({0, 0}, {{10, 0}}, 0.6)};
  World world = WorldOf(scenario);
  for (int i = 0; i < 200; ++i) {
    world.Take(Drive(1, world.Now(), 3, 3));
    world.Advance(true);
  }
  EXPECT_GT(world.Bodies()[0].world_from_body.position_world.x, 2);
  EXPECT_LE(At(world).x + 0.5, world.Bodies()[0].world_from_body.position_world.x);
}

TEST(Obstacle, ACartWaitsAtAClosedDoorAndGoesOnWhenItOpens) {
  Scenario scenario = ScenarioOf({});
  scenario.obstacles = {Cart({0, 0}, {{10, 0}}, 0.5)};
  scenario.doors = {{.from_world = {2, 1}, .to_world = {2, -1}, .closed_s = 8, .open_s = 60}};
  World world = WorldOf(scenario);
  Advance(&world, 150);
  EXPECT_NEAR(At(world).x, 1.75, kTouch_m);
  Advance(&world, 50);
  EXPECT_GT(At(world).x, 2);
}

TEST(Door, FollowsItsTimes) {
  SlidingDoor door({.from_world = {0, 0}, .to_world = {2, 0}, .closed_s = 1, .open_s = 2});
  const auto at = [&](int tick) {
    const Leaf leaf = door.Plan(true, tick * kDt_s, kDt_s);
    door.Settle(leaf, kDt_s);
    return door.Opening();
  };
  for (int tick = 1; tick <= 20; ++tick) ASSERT_NEAR(at(tick), 0, 1e-9);
  for (int tick = 21; tick <= 40; ++tick) ASSERT_NEAR(at(tick), (tick - 20) * 0.05, 1e-9);
  for (int tick = 41; tick <= 80; ++tick) ASSERT_NEAR(at(tick), 1, 1e-9);
  for (int tick = 81; tick <= 100; ++tick) ASSERT_NEAR(at(tick), (100 - tick) * 0.05, 1e-9);
}

TEST(Door, StartsWithinItsCycle) {
  const SlidingDoor door(
      {.from_world = {0, 0}, .to_world = {2, 0}, .closed_s = 1, .open_s = 2, .offset_s = 1.5});
  EXPECT_NEAR(door.Opening(), 0.5, 1e-12);
}

Scenario ClosingDoor() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0})});
  // Open at the start signal; closes over the vehicle from the left, 1 m/s, after 0.5 s.
  scenario.doors = {{.from_world = {0, 2},
                     .to_world = {0, -1},
                     .closed_s = 20,
                     .open_s = 5,
                     .move_s = 3,
                     .offset_s = 27.5}};
  return scenario;
}

TEST(Door, ClosingOnAVehicleStopsAtItsShell) {
  World world = WorldOf(ClosingDoor());
  Advance(&world, 90);
  EXPECT_EQ(world.Contacts(), 1U);
  EXPECT_NEAR(2 - 3 * (1 - world.Doors()[0].Opening()), 0.25, kTouch_m);
  EXPECT_EQ(world.Bodies()[0].world_from_body.position_world, (Vec2{0, 0}));
}

TEST(Door, GoesOnClosingWhenTheVehicleHasLeft) {
  World world = WorldOf(ClosingDoor());
  Advance(&world, 60);
  EXPECT_EQ(world.Contacts(), 1U);
  for (int i = 0; i < 80; ++i) {
    world.Take(Drive(1, world.Now(), 5, 5));
    world.Advance(true);
  }
  EXPECT_GT(world.Bodies()[0].world_from_body.position_world.x, 0.25);
  EXPECT_EQ(world.Doors()[0].Opening(), 0);
}

TEST(Door, OpenIsInNobodysWayAndClosedIsAWall) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0})});
  scenario.doors = {{.from_world = {1, 1}, .to_world = {1, -1}, .closed_s = 60}};
  World closed = WorldOf(scenario);
  scenario.doors[0].closed_s = 0;
  scenario.doors[0].open_s = 60;
  scenario.doors[0].offset_s = 2;
  World open = WorldOf(scenario);
  for (World* world : {&closed, &open}) {
    for (int i = 0; i < 100; ++i) {
      world->Take(Drive(1, world->Now(), 5, 5));
      world->Advance(true);
    }
  }
  EXPECT_NEAR(closed.Bodies()[0].world_from_body.position_world.x, 0.75, kTouch_m);
  EXPECT_EQ(closed.Contacts(), 1U);
  EXPECT_GT(open.Bodies()[0].world_from_body.position_world.x, 1.5);
  EXPECT_EQ(open.Contacts(), 0U);
}

}  // namespace
}  // namespace giveway::sim

#include "sim_world/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/types/math/math.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

constexpr double kWheel_m = 0.0975;

Scenario Facing(double distance_m) {
  return ScenarioOf({VehicleAt(1, {}), VehicleAt(2, {{distance_m, 0}, kPi})});
}

double X(const World& world, std::size_t i) {
  return world.Bodies()[i].world_from_body.position_world.x;
}

TEST(World, EncodersAreEnoughForPerfectDeadReckoning) {
  Scenario scenario = Facing(1.3);
  scenario.walls = {{{-1, 0.4}, {3, 0.4}}};
  World world = WorldOf(scenario);
  Pose reckoned = scenario.vehicles[0].start_world;
  for (int i = 0; i < 400; ++i) {
    world.Take(Drive(1, world.Now(), 3 * Sin(i * 0.05), 2 + Cos(i * 0.03)));
    world.Take(Drive(2, world.Now(), 2, 2));
    world.Advance(true);
    const Body& body = world.Bodies()[0];
    reckoned = AdvanceArc(reckoned, TwistFromWheels(body.profile.drive, body.encoders), 0.05);
    ASSERT_EQ(reckoned, body.world_from_body) << i;
  }
  EXPECT_GT(world.Contacts(), 0U);  // cut ticks were among them
}

// A vehicle that misses scans learns from the count how far it rolled, encoder errors included; a
// body that is put into the world again counts from zero.
TEST(World, EncodersCountWhatTheyTell) {
  Scenario scenario = Facing(0.6);
  scenario.vehicles[0].profile.encoder_noise = 0.1;
  World world = WorldOf(scenario);
  WheelAngles expected;
  for (int i = 0; i < 200; ++i) {
    DriveAll(&world, 2, 3 * Cos(i * 0.05), 1);
    expected = CountOn(expected, world.Bodies()[0].encoders, 0.05);
    ASSERT_EQ(world.Bodies()[0].counted, expected) << i;
  }
  EXPECT_GT(world.Contacts(), 0U);  // cut ticks were among them
  EXPECT_NE(expected, WheelAngles{});
  world.Remove(VehicleId{1});
  world.Join(VehicleId{1});
  EXPECT_EQ(world.Bodies()[0].counted, WheelAngles{});
}

TEST(World, BodiesStandUntilTheyAreToldToDrive) {
  World world = WorldOf(Facing(3));
  world.Advance(false);
  world.Take(Drive(1, Tick{1}, 5, 5));
  world.Advance(false);
  EXPECT_EQ(X(world, 0), 0);
  EXPECT_EQ(world.Now(), Tick{2});
  EXPECT_EQ(world.Bodies()[0].sonar.readings[3].kind, Echo::kEcho);
}

TEST(World, HeadOnBodiesStopAtEachOthersShellAndCountOneContact) {
  World world = WorldOf(Facing(0.6));
  std::size_t entered = 0;
  for (int i = 0; i < 60; ++i) {
    DriveAll(&world, 4, 4, 1);
    entered += world.NewContacts().size();
  }
  EXPECT_EQ(world.Contacts(), 1U);
  EXPECT_EQ(entered, 1U);
  const double gap = X(world, 1) - X(world, 0) - 0.5;
  EXPECT_GE(gap, 0);
  EXPECT_LE(gap, kTouch_m);
  EXPECT_EQ(world.Bodies()[0].wheels, WheelSpeeds{});
  EXPECT_EQ(world.Approaches().Closest()->gap_m, 0);
}

TEST(World, ARammedBodyThatStandsIsNotPushed) {
  World world = WorldOf(Facing(0.6));
  for (int i = 0; i < 60; ++i) {
    world.Take(Drive(1, world.Now(), 4, 4));
    world.Advance(true);
  }
  EXPECT_EQ(X(world, 1), 0.6);
  EXPECT_NEAR(X(world, 0), 0.1, kTouch_m);
}

TEST(World, ABodyInContactMayBackOutAndMeetAgain) {
  World world = WorldOf(Facing(0.6));
  DriveAll(&world, 4, 4, 40);
  DriveAll(&world, -4, -4, 40);
  EXPECT_GT(X(world, 1) - X(world, 0), 0.6);
  EXPECT_EQ(world.Contacts(), 1U);
  DriveAll(&world, 4, 4, 200);
  EXPECT_EQ(world.Contacts(), 2U);
}

TEST(World, AWallIsAContactWithNobody) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {})});
  scenario.walls = {{{0.3, -1}, {0.3, 1}}};
  World world = WorldOf(scenario);
  std::vector<Contact> contacts;
  for (int i = 0; i < 60; ++i) {
    DriveAll(&world, 4, 4, 1);
    contacts.insert(contacts.end(), world.NewContacts().begin(), world.NewContacts().end());
  }
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].vehicle, VehicleId{1});
  EXPECT_EQ(contacts[0].other, kNoVehicle);
  EXPECT_EQ(contacts[0].other_position_world, (Vec2{0.3, 0}));
  EXPECT_NEAR(X(world, 0), 0.05, kTouch_m);
}

TEST(World, TheContactTickIsCutToTheClosedFormsMoment) {
  // Full speed first, so that the gap of the deciding tick is known exactly.
  World world = WorldOf(Facing(2.0));
  DriveAll(&world, 4, 4, 30);
  const double before = X(world, 1) - X(world, 0) - 0.5;
  ASSERT_GT(before, 0);
  double gap = before;
  while (world.Contacts() == 0) {
    gap = X(world, 1) - X(world, 0) - 0.5;
    DriveAll(&world, 4, 4, 1);
  }
  // Each did half of the gap: encoders show the share of the tick that was driven.
  const double driven_m = world.Bodies()[0].encoders.left_rad_s * kWheel_m * 0.05;
  EXPECT_NEAR(driven_m, gap / 2, kTouch_m);
  EXPECT_EQ(world.Bodies()[0].wheels, WheelSpeeds{});
}

TEST(World, AThirdBodyRunsIntoTheTwoThatStopped) {
  World world = WorldOf(
      ScenarioOf({VehicleAt(1, {}), VehicleAt(2, {{0.6, 0}, kPi}), VehicleAt(3, {{-0.55, 0}, 0})}));
  DriveAll(&world, 4, 4, 100);
  EXPECT_EQ(world.Contacts(), 2U);
  EXPECT_GE(X(world, 0) - X(world, 2), 0.5);
  EXPECT_NEAR(X(world, 0) - X(world, 2), 0.5, kTouch_m);
}

TEST(World, AVehicleWhoseCommandIsTooOldIsBrakedByTheWorld) {
  World world = WorldOf(ScenarioOf({VehicleAt(1, {})}));
  DriveAll(&world, 4, 4, 40);  // the last command answers tick 39
  for (std::uint32_t age = 2; age <= 3; ++age) {
    world.Advance(true);
    EXPECT_TRUE(world.Bodies()[0].obeyed) << age;
  }
  world.Advance(true);
  EXPECT_FALSE(world.Bodies()[0].obeyed);
  EXPECT_LT(world.Bodies()[0].ForwardSpeed(), 4 * kWheel_m);
  for (int i = 0; i < 20; ++i) world.Advance(true);
  EXPECT_EQ(world.Bodies()[0].ForwardSpeed(), 0);
}

TEST(World, ANewCommandEndsTheWatchdogsBraking) {
  World world = WorldOf(ScenarioOf({VehicleAt(1, {})}));
  DriveAll(&world, 4, 4, 10);
  for (int i = 0; i < 20; ++i) world.Advance(true);
  DriveAll(&world, 4, 4, 1);
  EXPECT_GT(world.Bodies()[0].ForwardSpeed(), 0);
}

TEST(World, CommandsThatMakeNoSenseAreIgnoredAndCounted) {
  World world = WorldOf(ScenarioOf({VehicleAt(1, {})}));
  DriveAll(&world, 4, 4, 3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(world.Take(Drive(1, world.Now(), nan, 4)));
  EXPECT_FALSE(world.Take(Drive(1, world.Now(), 4, -infinite)));
  EXPECT_FALSE(world.Take(Drive(9, world.Now(), 4, 4)));
  MotorCommand other_world = Drive(1, world.Now(), 4, 4);
  other_world.epoch = WorldEpoch{8};
  EXPECT_FALSE(world.Take(other_world));
  EXPECT_FALSE(world.Take(Drive(1, Tick{1}, 4, 4)));                // older than the one held
  EXPECT_FALSE(world.Take(Drive(1, After(world.Now(), 1), 4, 4)));  // answers the future
  EXPECT_EQ(world.Commands().not_finite, 2U);
  EXPECT_EQ(world.Commands().unknown_vehicle, 1U);
  EXPECT_EQ(world.Commands().wrong_epoch, 1U);
  EXPECT_EQ(world.Commands().out_of_order, 2U);
  EXPECT_EQ(world.Commands().accepted, 3U);
  world.Advance(true);
  EXPECT_TRUE(std::isfinite(X(world, 0)));
  EXPECT_EQ(world.Bodies()[0].command.target, (WheelSpeeds{4, 4}));
}

TEST(World, ARemovedBodyIsNeitherSensedNorInTheWay) {
  World world = WorldOf(Facing(1.0));
  world.Advance(true);
  EXPECT_EQ(world.Bodies()[0].sonar.readings[3].kind, Echo::kEcho);
  world.Remove(VehicleId{2});
  DriveAll(&world, 4, 4, 100);
  EXPECT_EQ(world.Bodies()[0].sonar.readings[3].kind, Echo::kClear);
  EXPECT_EQ(world.Contacts(), 0U);
  EXPECT_GT(X(world, 0), 1.0);
}

// Two pass each other at right angles; the closest moment lies between two ticks.
TEST(World, TheClosestApproachIsFoundBetweenTicks) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{6, 0.6}, kPi})});
  scenario.expect.parted = true;
  World world = WorldOf(scenario);
  double closest_at_ticks = 10;
  for (int i = 0; i < 200; ++i) {
    DriveAll(&world, 8, 8.0, 1);
    const Vec2 offset = world.Bodies()[1].world_from_body.position_world -
                        world.Bodies()[0].world_from_body.position_world;
    closest_at_ticks = std::min(closest_at_ticks, Norm(offset) - 0.5);
  }
  const ClosestApproach closest = world.Approaches().Closest().value();
  EXPECT_NEAR(closest.gap_m, 0.1, 1e-9);
  EXPECT_GT(closest_at_ticks, 0.1 + 1e-5);
  EXPECT_NEAR(closest.position_world.x, closest.other_position_world.x, 1e-6);
  EXPECT_EQ(closest.vehicle, VehicleId{1});
  EXPECT_EQ(closest.other, VehicleId{2});
  EXPECT_TRUE(world.Approaches().Parted(world.Bodies()));
}

TEST(World, APairAtItsClosestHasNotParted) {
  Scenario scenario = Facing(3);
  scenario.expect.parted = true;
  World world = WorldOf(scenario);
  DriveAll(&world, 2, 2, 20);
  EXPECT_FALSE(world.Approaches().Parted(world.Bodies()));
}

}  // namespace
}  // namespace giveway::sim

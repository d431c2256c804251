#include "services/vehicle/vehicle.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include "tests/support/brain_bench.h"

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

// Every allocation of this test program is counted. Not inlined: the compiler would see malloc and
// delete meet, and warn.
__attribute__((noinline)) void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// Otherwise the library's own would be used: not counted, and not compatible with free().
__attribute__((noinline)) void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

RangeScan Arc() {
  RangeScan scan = ClearScan(0);
  scan.wheels = {2.0, 3.0};
  return scan;
}

TEST(Vehicle, BeaconsAlwaysHeardOrNot) {
  BrainBench bench(test::DefaultOptions());
  for (std::uint32_t i = 1; i <= 3; ++i) EXPECT_EQ(bench.StepBlind().beacon.seq, i);
}

TEST(Vehicle, DeadReckonsAlongExactArcs) {
  BrainBench bench(test::DefaultOptions());
  Outputs out;
  for (int i = 0; i < 20; ++i) out = bench.Step(Arc());
  const Pose expected = AdvanceArc({}, TwistFromWheels({}, {2.0, 3.0}), 1.0);
  EXPECT_NEAR(out.beacon.world_from_body.position_world.x, expected.position_world.x, 1e-12);
  EXPECT_NEAR(out.beacon.world_from_body.position_world.y, expected.position_world.y, 1e-12);
  EXPECT_NEAR(out.beacon.world_from_body.heading_rad, expected.heading_rad, 1e-12);
}

TEST(Vehicle, ALostTickIsBridgedAndCostsCertainty) {
  BrainBench whole(test::DefaultOptions());
  BrainBench gappy(test::DefaultOptions());
  Outputs out, bridged;
  for (int i = 0; i < 10; ++i) {
    out = whole.Step(Arc());
    bridged = i == 5 ? gappy.StepBlind() : gappy.Step(Arc());
  }
  EXPECT_NEAR(bridged.beacon.world_from_body.position_world.x,
              out.beacon.world_from_body.position_world.x, 1e-12);
  EXPECT_GT(SigmaPosition(bridged.beacon.covariance), SigmaPosition(out.beacon.covariance));
}

// A process that was paused while its vehicle braked and stood: the encoder count says how far it
// went, not the speed before or after.
TEST(Vehicle, AfterAPauseItKnowsByItsEncodersHowFarItRolled) {
  BrainBench bench(test::DefaultOptions());
  RangeScan scan = ClearScan(0);
  scan.wheels = {4, 4};
  for (int i = 0; i < 10; ++i) bench.Step(scan);
  for (int i = 0; i < 4; ++i) bench.StepBlind();  // rolls on
  bench.RollOn({0, 0});
  for (int i = 0; i < 60; ++i) bench.StepBlind();  // stands
  scan.wheels = {};
  const Outputs out = bench.Step(scan);
  EXPECT_NEAR(out.beacon.world_from_body.position_world.x, 14 * 0.05 * 4 * 0.0975, 1e-9);
  EXPECT_LT(SigmaPosition(out.beacon.covariance), 0.01);
}

TEST(Vehicle, AfterAPauseItDoesNotKnowWhetherItTurnedFirstOrLast) {
  BrainBench bench(test::DefaultOptions());
  bench.Step(Arc());
  bench.RollOn({2, 4});
  for (int i = 0; i < 20; ++i) bench.StepBlind();
  const double driven_m = 21 * 0.05 * 3 * 0.0975;
  const double turned_rad = 21 * 0.05 * 2 * 0.0975 / 0.33;
  RangeScan scan = ClearScan(0);
  scan.wheels = {2, 4};
  const double sigma_m = SigmaPosition(bench.Step(scan).beacon.covariance);
  EXPECT_GT(sigma_m, 0.4 * driven_m * turned_rad);
  EXPECT_LT(sigma_m, 0.7 * driven_m * turned_rad);
}

TEST(Vehicle, CountsThatNoDriveMadeAreNotBelieved) {
  BrainBench bench(test::DefaultOptions());
  RangeScan scan = ClearScan(0);
  scan.wheels = {2, 2};
  bench.Step(scan);
  bench.RollOn({1e6, 1e6});
  bench.StepBlind();
  const Outputs out = bench.Step(scan);
  EXPECT_NEAR(out.beacon.world_from_body.position_world.x, 3 * 0.05 * 2 * 0.0975, 1e-9);
  EXPECT_GT(SigmaPosition(out.beacon.covariance), 0);
}

// Ticks restart with a world; a wait counted in the old world's ticks would be longer than the new
// one is old, and peers would reject it.
TEST(Vehicle, ANewWorldEpochForgetsWhatTheOldOneShowed) {
  VehicleOptions options = test::DefaultOptions();
  options.ageing_limit = 2 * options.tick_period;
  BrainBench bench(options);
  const Beacon standing = BeaconOf(2, 11, {{1.0, 0.4}, -kPi / 2});
  Outputs out;
  for (int tick = 1; tick <= 12; ++tick) {
    RangeScan scan = ClearScan(0);
    test::SetEcho(&scan, 0, 0.95 - 0.02 * tick);  // approaches, unidentified
    out = bench.Step(scan, tick == 12 ? std::vector{standing} : std::vector<Beacon>{});
  }
  ASSERT_EQ(out.command.decision.rule, Rule::kUnidentifiedMotion);
  ASSERT_GT(out.beacon.order.waited_ticks, 2U);
  ASSERT_EQ(bench.Brain().PeersHeard(), 1U);
  Vehicle brain(options, 42);
  brain.Restore(bench.Brain().State());
  RangeScan first = ClearScan(1);
  first.epoch = WorldEpoch{8};
  out = brain.Step({.now = bench.Now() + options.tick_period, .scan = first});
  EXPECT_EQ(out.beacon.order.waited_ticks, 0U);
  EXPECT_TRUE(IsInRange(out.beacon));
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  EXPECT_EQ(brain.PeersHeard(), 0U);
}

// At 1.1 m/s with weak brakes a peer 12.2 m away already matters.
TEST(Vehicle, KeepsClearOfWhomItNeedsLongToStopFor) {
  VehicleOptions options = test::OptionsWithoutUltrasonics();
  options.cruise_m_s = 1.1;
  options.profile.deceleration_m_s2 = 0.05;
  options.emission_radius_m = 30;
  options.goal.at_world = {100, 0};
  BrainBench bench(options);
  RangeScan scan = ClearScan(0);
  scan.wheels = {1.1 / 0.0975, 1.1 / 0.0975};
  bench.Step(scan);
  Beacon standing = BeaconOf(2, 1, {{11.7, 0}, kPi});
  standing.rule = Rule::kArrived;
  const Outputs out = bench.Step(scan, {standing});
  EXPECT_EQ(out.command.decision.rule, Rule::kKeepClear);
}

// Regression: vehicle 7 stood for 4.5 s after it had heard something move in the last fault of a
// soak, which failed by tenths of a second: a fleet drives again within five.
TEST(Vehicle, WhoeverHeardSomethingMoveDrivesAgainWithinFourSeconds) {
  for (std::uint32_t id = 1; id <= 24; ++id) {
    BrainBench bench(test::DefaultOptions(id));
    Outputs out;
    for (int tick = 1; tick <= 12; ++tick) {
      RangeScan scan = ClearScan(0);
      test::SetEcho(&scan, 0, 0.95 - 0.02 * tick);
      out = bench.Step(scan);
    }
    ASSERT_EQ(out.command.decision.rule, Rule::kUnidentifiedMotion) << id;
    for (int tick = 0; tick < 80; ++tick) out = bench.Step(ClearScan(0));
    EXPECT_EQ(out.command.decision.rule, Rule::kCruise) << id;
  }
}

// A turn in the old world must not count in the new one, where echoes then reveal motion.
TEST(Vehicle, ANewWorldEpochForgetsThatItTurned) {
  BrainBench bench(test::DefaultOptions());
  for (int i = 0; i < 100; ++i) bench.Step(ClearScan(0));
  RangeScan turning = ClearScan(0);
  turning.wheels = {-1, 1};
  for (int i = 0; i < 3; ++i) bench.Step(turning);
  Vehicle brain(test::DefaultOptions(), 42);
  brain.Restore(bench.Brain().State());
  Outputs out;
  for (std::uint32_t tick = 1; tick <= 12; ++tick) {
    RangeScan scan = ClearScan(tick);
    scan.epoch = WorldEpoch{8};
    test::SetEcho(&scan, 0, 0.95 - 0.02 * tick);  // something comes nearer
    out = brain.Step({.now = bench.Now() + tick * std::chrono::milliseconds(50), .scan = scan});
  }
  EXPECT_EQ(out.command.decision.rule, Rule::kUnidentifiedMotion);
}

// Regression: exact ultrasonics hear the front of a building ahead at the rim of the cone that
// looks to the side, nearly four times as fast as the vehicle comes nearer; it halted at every
// doorway.
TEST(Vehicle, TheFrontOfABuildingMetAtTheRimOfASideConeIsNoMover) {
  const RobotModel profile = test::DefaultOptions().profile;
  const double rim_cosine = Cos(profile.sonar[0].bearing_rad - profile.sonar_half_angle_rad);
  BrainBench bench(test::DefaultOptions());
  for (int i = 0; i < 16; ++i) {
    RangeScan scan = ClearScan(0);
    scan.wheels = test::Rolling(0.3);
    const double ahead_m = 0.25 - 0.3 * 0.05 * i;  // of the transducer
    test::SetEcho(&scan, 0, ahead_m / rim_cosine);
    EXPECT_NE(bench.Step(scan).command.decision.rule, Rule::kUnidentifiedMotion) << i;
  }
}

// From corridor 2069 of mixed fleets: on the spot the rim of a cone leapt along a wall, which was
// taken for something that moves, and the vehicle stood for two and a half seconds, a hundred
// times.
TEST(Vehicle, AnEchoThatLeapsWhileItTurnsOnTheSpotIsNoMover) {
  BrainBench bench(test::DefaultOptions());
  for (int i = 0; i < 16; ++i) {
    RangeScan scan = ClearScan(0);
    scan.wheels = {-0.2, 0.2};  // 0.12 rad/s
    test::SetEcho(&scan, 0, 0.95 - 0.04 * i);
    EXPECT_NE(bench.Step(scan).command.decision.rule, Rule::kUnidentifiedMotion) << i;
  }
}

// Nor is it patient with what no beacon explains: that may never go.
TEST(Vehicle, SeeksAnotherHeadingBeforeAMoverThatStays) {
  BrainBench bench(test::DefaultOptions());
  double range_m = 0.95;
  for (int i = 0; i < 400; ++i) {
    RangeScan scan = ClearScan(0);
    range_m = i % 40 < 8 ? 0.95 - 0.05 * (i % 40) : 0.95;
    test::SetEcho(&scan, 0, range_m);
    bench.Step(scan);
  }
  EXPECT_GT(bench.Brain().State().progress.no_progress_ticks, 200U);
}

// Its patience had run out before the run started, and it set off at an angle.
TEST(Vehicle, LosesNoPatienceBeforeTheRunStarts) {
  BrainBench bench(test::DefaultOptions());
  for (int i = 0; i < 400; ++i) {
    RangeScan scan = ClearScan(0);
    scan.run_state = RunState::kWaiting;
    EXPECT_EQ(bench.Step(scan).command.decision.rule, Rule::kNotRunning);
  }
  EXPECT_LE(bench.Brain().State().progress.no_progress_ticks, 1U);
}

TEST(Vehicle, WhatComesFromTheSideFasterThanThePathExplainsIsAMover) {
  BrainBench bench(test::DefaultOptions());
  bool deaf = false;
  for (int i = 0; i < 16; ++i) {
    RangeScan scan = ClearScan(0);
    scan.wheels = test::Rolling(0.3);
    test::SetEcho(&scan, 0, 0.95 - 0.6 * 0.05 * i);
    deaf = deaf || bench.Step(scan).command.decision.rule == Rule::kUnidentifiedMotion;
  }
  EXPECT_TRUE(deaf);
}

// A NaN in the pose would never leave it again.
TEST(Vehicle, AScanThatCannotBeItsOwnIsRefusedAndCounted) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto spoil) {
    Vehicle brain(test::DefaultOptions(), 42);
    RangeScan scan = ClearScan(1);
    brain.Step({.now = std::chrono::milliseconds(50), .scan = scan});
    const Pose before = brain.State().motion.odometry.WorldFromBody();
    scan = ClearScan(2);
    spoil(&scan);
    const Outputs out = brain.Step({.now = std::chrono::milliseconds(100), .scan = scan});
    EXPECT_EQ(out.beacon.tick, Tick{1});
    EXPECT_EQ(out.beacon.world_from_body, before);
    return brain.State().counters.scans_refused == 1;
  };
  EXPECT_FALSE(refused([](RangeScan* scan) { *scan = ClearScan(1); }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->wheels.left_rad_s = kNan; }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->wheels = {1e300, 1e300}; }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->wheels = {-100, 100}; }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->counted.right_rad = kNan; }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->counted.left_rad = -1e10; }));
  EXPECT_TRUE(refused([](RangeScan* scan) { test::SetEcho(scan, 0, kNan); }));
  EXPECT_TRUE(refused([](RangeScan* scan) { test::SetEcho(scan, 0, -0.1); }));
  EXPECT_TRUE(refused([](RangeScan* scan) { test::SetEcho(scan, 0, 7); }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->readings[7].tick = Tick{3}; }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->tick = kNoTick; }));
  EXPECT_TRUE(refused([](RangeScan* scan) { scan->epoch = kNoEpoch; }));
}

TEST(Vehicle, ANewWorldEpochStartsDeadReckoningAnew) {
  BrainBench bench(test::DefaultOptions());
  for (int i = 0; i < 5; ++i) bench.Step(Arc());
  RangeScan scan = ClearScan(0);
  scan.epoch = WorldEpoch{8};
  const Outputs out = bench.Step(scan);
  EXPECT_EQ(out.beacon.world_from_body.position_world, Vec2{});
  EXPECT_EQ(out.beacon.world_epoch, WorldEpoch{8});
}

// Regression: weak brakes let it roll through its goal, and it stood beyond for ever.
TEST(Vehicle, RolledOutOfItsGoalItHasNotArrived) {
  VehicleOptions options = test::DefaultOptions();
  options.goal = {.set = true, .at_world = {0.3, 0}, .radius_m = 0.1};
  BrainBench bench(options);
  bool arrived = false;
  Outputs out;
  for (int i = 0; i < 30; ++i) {
    RangeScan scan = ClearScan(0);
    scan.wheels = test::Rolling(0.3);
    out = bench.Step(scan);
    arrived = arrived || out.command.decision.rule == Rule::kArrived;
  }
  EXPECT_TRUE(arrived);
  EXPECT_NE(out.command.decision.rule, Rule::kArrived);
}

TEST(Vehicle, AScanOlderThanTheLastMovesNothing) {
  Vehicle vehicle(test::DefaultOptions(), 42);
  Inputs inputs;
  for (std::uint32_t tick : {1U, 2U, 3U}) {
    RangeScan scan = Arc();
    scan.tick = Tick{tick};
    inputs.scan = scan;
    vehicle.Step(inputs);
  }
  const Vec2 before = vehicle.State().motion.odometry.WorldFromBody().position_world;
  inputs.scan->tick = Tick{2};
  vehicle.Step(inputs);
  EXPECT_EQ(vehicle.State().motion.odometry.WorldFromBody().position_world, before);
  EXPECT_EQ(vehicle.State().world.tick, Tick{3});
}

TEST(Vehicle, TheSameInputsGiveTheSameBits) {
  BrainBench first(test::DefaultOptions());
  BrainBench second(test::DefaultOptions());
  for (std::uint32_t i = 1; i <= 50; ++i) {
    const std::vector<Beacon> heard = {BeaconOf(2, i, {.position_world = {2, 1}})};
    first.Step(Arc(), heard);
    second.Step(Arc(), heard);
    ASSERT_EQ(first.Brain().Hash(), second.Brain().Hash()) << i;
  }
}

TEST(Vehicle, ARunContinuesFromASnapshotBitForBit) {
  const VehicleOptions options = test::DefaultOptions();
  Vehicle original(options, 42);
  Vehicle restored(options, 42);
  for (std::uint32_t tick = 1; tick <= 60; ++tick) {
    if (tick == 30) restored.Restore(original.State());
    RangeScan scan = Arc();
    scan.tick = Tick{tick};
    Inputs inputs;
    inputs.now = tick * options.tick_period;
    inputs.scan = scan;
    original.Step(inputs);
    if (tick < 30) continue;
    restored.Step(inputs);
    ASSERT_EQ(original.Hash(), restored.Hash()) << tick;
  }
}

TEST(Vehicle, StepAllocatesNothing) {
  Vehicle vehicle(test::DefaultOptions(), 42);
  std::vector<ReceivedBeacon> heard(50);
  const auto step = [&](std::uint32_t tick) {
    for (std::uint32_t i = 0; i < heard.size(); ++i) {
      const Beacon beacon = BeaconOf(i + 2, tick, {.position_world = {1.0 + 0.05 * i, 2.0}});
      heard[i] = test::Received(beacon, tick * std::chrono::milliseconds(50));
    }
    Inputs inputs;
    inputs.now = tick * std::chrono::milliseconds(50);
    inputs.scan = ClearScan(tick);
    inputs.beacons = heard;
    return vehicle.Step(inputs);
  };
  for (std::uint32_t tick = 1; tick <= 5; ++tick) step(tick);
  const std::size_t before = allocations;
  for (std::uint32_t tick = 6; tick <= 100; ++tick) step(tick);
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace giveway

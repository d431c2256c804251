// A stuck vehicle, one that makes no progress though it waits for no peer, tries one heading after
// another.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "services/types/math/math.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using Neighbours = std::function<std::vector<Beacon>(std::uint32_t tick)>;

// The headings tried in turn by a vehicle that is to drive east, while its wheels turn as `wheels`
// says: by default they are held.
std::vector<double> HeadingsTried(std::uint32_t ticks, const Neighbours& beside,
                                  WheelSpeeds wheels = {}) {
  test::BrainBench bench(test::DefaultOptions());
  const VehicleState& state = bench.Brain().State();
  std::vector<double> tried;
  Tick last = kNoTick;
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    RangeScan scan = test::ClearScan(0);
    scan.wheels = wheels;
    bench.Step(scan, tick == 0 ? std::vector<Beacon>{} : beside(tick));
    if (state.progress.away_tick != last) tried.push_back(state.progress.away_rad);
    last = state.progress.away_tick;
  }
  return tried;
}

std::vector<Beacon> Nobody(std::uint32_t /*tick*/) { return {}; }

Beacon LeaderAhead(std::uint32_t tick) {
  Beacon leader = test::BeaconOf(2, tick, {{0.8, 0}});
  leader.toward_world = {20, 0};
  leader.rule = Rule::kKeepClear;
  return leader;
}

// No progress for six seconds, stuck after ten, then another heading every three.
TEST(Caught, ItTriesHeadingsAllRound) {
  EXPECT_TRUE(HeadingsTried(300, Nobody).empty());
  std::vector<double> tried = HeadingsTried(300 + 20 * 61, Nobody);
  ASSERT_GE(tried.size(), 19U);
  std::ranges::sort(tried);
  for (std::size_t i = 0; i + 1 < tried.size(); ++i) {
    EXPECT_LT(tried[i + 1] - tried[i], 0.7);
    EXPECT_GT(tried[i + 1] - tried[i], 0.05);
  }
}

// But no heading that leads into a peer: here one that stands to the north.
TEST(Caught, ItTriesNoHeadingThatLeadsIntoAClaim) {
  const auto parked = [](std::uint32_t tick) {
    Beacon beacon = test::BeaconOf(2, tick, {{0, 0.6}});
    beacon.toward_world = beacon.world_from_body.position_world;
    beacon.rule = Rule::kArrived;
    return std::vector{beacon};
  };
  const std::vector<double> tried = HeadingsTried(300 + 20 * 61, parked);
  ASSERT_GE(tried.size(), 19U);
  for (const double heading_rad : tried) EXPECT_LT(Sin(heading_rad), 0.7);
}

// Ultrasonics that are late for 20 s: a vehicle on an empty floor turned to and fro for minutes
// afterwards, from one heading to the next.
TEST(Caught, ItIsNotWhileItHaltsForStaleRanges) {
  test::BrainBench bench(test::DefaultOptions());
  RangeScan scan = test::ClearScan(0);
  test::SetEcho(&scan, 3, 4);
  Outputs out;
  for (int i = 0; i < 400; ++i) out = bench.StepAsFired(scan);
  ASSERT_EQ(out.command.decision.rule, Rule::kRangesStale);
  EXPECT_LT(bench.Brain().State().progress.no_progress_ticks, 10U);
  out = bench.Step(test::ClearScan(0));
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  EXPECT_EQ(bench.Brain().State().progress.away_tick, kNoTick);
}

TEST(Caught, AQueueIsWaitedIn) {
  const auto leader = [](std::uint32_t tick) { return std::vector{LeaderAhead(tick)}; };
  EXPECT_TRUE(HeadingsTried(4000, leader).empty());
}

// The leader is blocked by a third, which waits for this very vehicle.
std::vector<Beacon> CircleOfThree(std::uint32_t tick) {
  Beacon leader = LeaderAhead(tick);
  leader.blocked_by = VehicleId{3};
  Beacon third = test::BeaconOf(3, tick, {{0.8, 1.5}});
  third.toward_world = {-20, 1.5};
  third.blocked_by = test::DefaultOptions().id;
  return {leader, third};
}

TEST(Caught, AQueueThatClosesToACircleIsNone) {
  EXPECT_FALSE(HeadingsTried(4000, CircleOfThree).empty());
}

TEST(Caught, ACircleIsLeftToTheSide) {
  test::BrainBench bench(test::DefaultOptions());
  Outputs out;
  double farthest_m = 0;
  for (std::uint32_t tick = 0; tick < 4000; ++tick) {
    RangeScan scan = test::ClearScan(0);
    scan.wheels = out.command.target;
    out = bench.Step(scan, tick == 0 ? std::vector<Beacon>{} : CircleOfThree(tick));
    farthest_m = std::max(farthest_m, Magnitude(out.beacon.world_from_body.position_world.y));
  }
  EXPECT_GT(farthest_m, 0.1);
}

// From one_lane 69: along a heading without a goal a vehicle drove at 0.8 m/s across the lane, and
// touched the wall on the other side.
TEST(Caught, WhatStoppedItIsLeftAtWalkingPace) {
  VehicleOptions options = test::DefaultOptions();
  options.cruise_m_s = 0.6;
  test::BrainBench bench(options);
  const auto speed_m_s = [&options](const Outputs& out) {
    return TwistFromWheels(options.profile.drive, out.command.target).forward_m_s;
  };
  RangeScan before_wall = test::ClearScan(0);
  test::SetEcho(&before_wall, 1, 0.12);
  Outputs out;
  while (bench.Brain().State().progress.away_tick == kNoTick) {
    ASSERT_LT(bench.NextTick(), 400U);
    out = bench.Step(before_wall);
  }
  double fastest_m_s = 0;
  for (std::uint32_t tick = 0; tick < 55; ++tick) {
    RangeScan scan = test::ClearScan(0);
    scan.wheels = out.command.target;
    out = bench.Step(scan);
    fastest_m_s = std::max(fastest_m_s, speed_m_s(out));
  }
  EXPECT_GT(fastest_m_s, 0.1);
  EXPECT_LE(fastest_m_s, 0.2 + 1e-9);
  // Then it drives to its goal again.
  for (std::uint32_t tick = 0; tick < 100; ++tick) {
    RangeScan scan = test::ClearScan(0);
    scan.wheels = out.command.target;
    out = bench.Step(scan);
  }
  EXPECT_GT(speed_m_s(out), 0.5);
}

// It makes no progress, but it turns: its sensors will see something new.
TEST(Caught, WhoeverDrivesInCirclesIsNot) {
  EXPECT_TRUE(HeadingsTried(2000, Nobody, {2, 3}).empty());
}

}  // namespace
}  // namespace giveway

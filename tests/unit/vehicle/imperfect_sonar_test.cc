// Ultrasonics that jitter, drop out and fire in turn: which readings the brain keeps, forgets and
// believes.
#include <gtest/gtest.h>

#include <limits>

#include "services/types/math/random.h"
#include "services/vehicle/estimation/cones.h"
#include "services/vehicle/estimation/range_view.h"
#include "services/vehicle/estimation/scan_check.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

VehicleOptions Slow() {
  VehicleOptions options = test::DefaultOptions();
  options.sonar_refresh = milliseconds(360);
  options.sonar_noise = 0.01;
  return options;
}

VehicleOptions Noisy(double noise = 0.01) {
  VehicleOptions options = test::DefaultOptions();
  options.sonar_noise = noise;
  return options;
}

class ImperfectRanges : public testing::Test {
 protected:
  // The sensor reads this at `tick`; the scan arrives in the same one.
  void Take(std::uint32_t tick, Echo kind, double range_m, double before_s = 0) {
    RangeScan scan = ClearScan(tick);
    scan.readings[3] = {kind, range_m, Tick{tick}, before_s};
    view_.TakeImperfect(scan, milliseconds(tick * 50), milliseconds(50), {});
  }
  RangeView view_;
};

TEST_F(ImperfectRanges, OneFiringThatHearsNothingForgetsNoEcho) {
  Take(1, Echo::kEcho, 0.8);
  Take(2, Echo::kClear, 0);
  EXPECT_EQ(view_[3].kind, Echo::kEcho);
  EXPECT_EQ(view_[3].range_m, 0.8);
  EXPECT_EQ(view_[3].echo_tick, Tick{1});
  EXPECT_EQ(view_[3].tick, Tick{2});  // it did fire: it is not blind
  Take(2, Echo::kClear, 0);           // said again, not fired again
  EXPECT_EQ(view_[3].kind, Echo::kEcho);
  Take(3, Echo::kClear, 0);
  EXPECT_EQ(view_[3].kind, Echo::kClear);
}

TEST_F(ImperfectRanges, ADropOutBetweenTwoEchoesCountsForNothing) {
  for (std::uint32_t tick = 1; tick <= 40; ++tick) {
    if (tick % 2 == 0) {
      Take(tick, Echo::kClear, 0);
    } else {
      Take(tick, Echo::kEcho, 2 - 0.01 * tick);
    }
    EXPECT_EQ(view_[3].kind, Echo::kEcho);
  }
  EXPECT_EQ(view_[3].streak, 19U);
  EXPECT_NEAR(view_[3].closing_m_s, 0.2, 0.02);
}

TEST_F(ImperfectRanges, NoDataIsNoDataAtOnce) {
  Take(1, Echo::kEcho, 0.8);
  Take(2, Echo::kNoData, 0);
  EXPECT_EQ(view_[3].kind, Echo::kNoData);
}

TEST_F(ImperfectRanges, TheRateRestsOnWhenTheTransducerFired) {
  // 0.4 m/s; slots of 40 ms are no multiples of a tick.
  std::uint32_t fired_ms = 0;
  for (int i = 0; i < 30; ++i) {
    fired_ms += 320;
    const std::uint32_t tick = (fired_ms + 49) / 50;
    Take(tick, Echo::kEcho, 5 - 0.0004 * fired_ms, 1e-3 * (tick * 50 - fired_ms));
  }
  EXPECT_NEAR(view_[3].closing_m_s, 0.4, 1e-6);
}

TEST_F(ImperfectRanges, TheRateErrsByNoMoreThanItsNoiseAllows) {
  for (const std::uint32_t every : {1U, 2U, 7U}) {
    Random random(7);
    double worst = 0;
    std::uint32_t tick = 0;
    for (int i = 0; i < 3000; ++i) {
      tick += every;
      Take(tick, Echo::kEcho, 1 + random.Gaussian(0.01));
      worst = std::max(worst, view_[3].closing_m_s);
    }
    EXPECT_LT(worst, 4 * 0.01 / kClosingTime_s) << every;
    EXPECT_GT(worst, 1 * 0.01 / kClosingTime_s) << every;
  }
}

TEST_F(ImperfectRanges, WhatMayHaveDroppedOutDoesNotSpeak) {
  Take(1, Echo::kEcho, 1);
  EXPECT_NE(view_.SpokeAt(Tick{1}) & 1U << 3, 0U);
  Take(2, Echo::kClear, 0);
  EXPECT_EQ(view_.SpokeAt(Tick{2}) & 1U << 3, 0U);
  Take(3, Echo::kClear, 0);
  EXPECT_NE(view_.SpokeAt(Tick{3}) & 1U << 3, 0U);
}

TEST(SlowSonar, AReadingMayBeOlderByTheRefresh) {
  const VehicleOptions options = Slow();
  RangeView view;
  RangeScan scan = ClearScan(12);
  scan.readings[6].tick = Tick{2};
  view.TakeImperfect(scan, milliseconds(600), options.tick_period, {});
  const std::uint32_t enabled = ConesOf(options.profile).enabled;
  const auto first_blind = [&](milliseconds now, std::uint32_t tick) {
    return view.FirstBlind(now, Tick{tick}, options, enabled);
  };
  EXPECT_EQ(first_blind(milliseconds(600), 12), -1);  // 500 ms old
  EXPECT_EQ(first_blind(milliseconds(600), 13), 6);   // 550 ms old
  EXPECT_EQ(first_blind(milliseconds(751), 12), static_cast<int>(kSensorCount));
}

TEST(SlowSonar, TheRefreshIsReactionTime) {
  EXPECT_NEAR(ReactionSeconds(Slow()), 0.46, 1e-12);
  EXPECT_NEAR(ReactionSeconds(test::DefaultOptions()), 0.1, 1e-12);
}

// The same echo lets a vehicle drive on whose sensors refresh 20 times a second, and slows one down
// whose sensors refresh 3 times a second.
TEST(SlowSonar, StopsSoonerBeforeAnObstacle) {
  const auto rule = [](const VehicleOptions& options) {
    BrainBench bench(options);
    RangeScan scan = ClearScan(1);
    scan.wheels = {0.3 / 0.0975, 0.3 / 0.0975};
    test::SetEcho(&scan, 3, 0.45);
    return bench.Step(scan).command.decision.rule;
  };
  EXPECT_EQ(rule(test::DefaultOptions()), Rule::kCruise);
  EXPECT_EQ(rule(Slow()), Rule::kObstacle);
}

TEST(SlowSonar, ADropOutDoesNotReleaseAHold) {
  BrainBench bench(Slow());
  RangeScan scan = ClearScan(1);
  test::SetEcho(&scan, 3, 0.2);
  EXPECT_EQ(bench.Step(scan).command.decision.rule, Rule::kObstacle);
  EXPECT_EQ(bench.Step(ClearScan(0)).command.decision.rule, Rule::kObstacle);
  EXPECT_EQ(bench.Step(ClearScan(0)).command.decision.rule, Rule::kCruise);
}

TEST(NoisySonar, AWallDroveUpToDoesNotMoveByItself) {
  for (const VehicleOptions& options : {Noisy(), Noisy(0.03), Slow()}) {
    Random random(11);
    BrainBench bench(options);
    const std::uint32_t every = options.sonar_refresh.count() > 0 ? 7 : 1;
    double at_m = 0;
    double speed = 0;
    RangeScan scan = ClearScan(0);
    for (std::uint32_t i = 0; i < 4000; ++i) {
      // Drives, brakes hard to a stand, and drives again.
      speed = i / 40 % 2 == 0 ? std::min(0.3, speed + 0.015) : std::max(0.0, speed - 0.03);
      at_m += 0.05 * speed;
      if (at_m > 0.6) at_m = 0;
      scan.wheels = {speed / 0.0975, speed / 0.0975};
      if (i % every == 0) {
        const double range = 1.1 - at_m;
        test::SetEcho(&scan, 3, range + random.Gaussian(options.sonar_noise * range));
        test::SetEcho(&scan, 4, range + random.Gaussian(options.sonar_noise * range));
      }
      const Outputs out = bench.StepAsFired(scan);
      EXPECT_NE(out.command.decision.rule, Rule::kUnidentifiedMotion) << i;
      scan.readings = bench.LastReadings();
    }
  }
}

// It rolled on for four ticks that it did not see, and stood for six: by its encoders 0.08 m in
// half a second.
TEST(NoisySonar, WhatItDroveInLostTicksIsByItsEncoders) {
  BrainBench bench(Noisy());
  RangeScan scan = ClearScan(0);
  scan.wheels = {4, 4};
  test::SetEcho(&scan, 3, 2.0);
  bench.Step(scan);
  for (int i = 0; i < 4; ++i) bench.StepBlind();
  bench.RollOn({0, 0});
  for (int i = 0; i < 5; ++i) bench.StepBlind();
  scan.wheels = {};
  test::SetEcho(&scan, 3, 1.922);
  bench.Step(scan);
  const SensorView& view = bench.Brain().State().sensed.ranges[3];
  EXPECT_GT(view.closing_m_s, 0);
  EXPECT_NEAR(view.own.forward_m_s, view.closing_m_s, 1e-9);
}

TEST(NoisySonar, WhatMovesByItselfIsStillHeard) {
  for (const VehicleOptions& options : {Noisy(), Slow()}) {
    Random random(13);
    BrainBench bench(options);
    const std::uint32_t every = options.sonar_refresh.count() > 0 ? 7 : 1;
    bool deaf = false;
    RangeScan scan = ClearScan(0);
    for (std::uint32_t i = 0; i < 50; ++i) {
      const double range = 1.8 - 0.5 * 0.05 * i;
      if (i % every == 0) test::SetEcho(&scan, 3, range + random.Gaussian(0.01 * range));
      deaf |= bench.StepAsFired(scan).command.decision.rule == Rule::kUnidentifiedMotion;
      scan.readings = bench.LastReadings();
    }
    EXPECT_TRUE(deaf);
  }
}

// An echo 300 ms old is where the peer was then, not where it is now.
TEST(SlowSonar, AnOldEchoOfAPeerIsStillThatPeer) {
  BrainBench bench(Slow());
  RangeScan scan = ClearScan(0);
  for (std::uint32_t i = 0; i < 30; ++i) {
    const double away_m = 2.6 - 1.2 * 0.05 * i;
    if (i % 7 == 0) test::SetEcho(&scan, 3, away_m - 0.25 - 0.17);
    const std::uint32_t tick = bench.NextTick();
    Beacon peer = BeaconOf(2, tick - 1, {.position_world = {away_m + 0.06, 0}, .heading_rad = kPi});
    peer.wheels = {1.2 / 0.0975, 1.2 / 0.0975};
    std::vector<Beacon> beacons;
    if (tick > 1) beacons = {peer};
    EXPECT_NE(bench.StepAsFired(scan, beacons).command.decision.rule, Rule::kUnidentifiedMotion)
        << i;
    scan.readings = bench.LastReadings();
  }
}

TEST(SlowSonar, AReadingFromTheFutureOrNowhereIsNotBelieved) {
  RangeScan scan = ClearScan(5);
  EXPECT_TRUE(IsBelievable(scan, Slow()));
  for (const double before_s : {-0.01, 0.06, std::numeric_limits<double>::quiet_NaN()}) {
    scan.readings[2].fired_before_s = before_s;
    EXPECT_FALSE(IsBelievable(scan, Slow())) << before_s;
  }
}

}  // namespace
}  // namespace giveway

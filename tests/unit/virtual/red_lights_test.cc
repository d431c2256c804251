// Which vehicles pass a red light, and which only come near.
#include "sim_world/virtual/red_lights.h"

#include <gtest/gtest.h>

#include "sim_world/virtual/invariants.h"

namespace giveway::sim {
namespace {

constexpr double kTick_s = 0.05;

// A stop line at x = 0 for traffic to the east, red from 10 s to 30 s; one vehicle, moved by hand.
class RedLightsTest : public testing::Test {
 protected:
  RedLightsTest() {
    scenario_.signals = {{.id = SignalId{1},
                          .line_from_world = {0, -1},
                          .line_to_world = {0, 1},
                          .green_s = 7,
                          .yellow_s = 3,
                          .red_s = 20}};
    VehicleOptions& options = scenario_.vehicles.emplace_back();
    options.id = VehicleId{1};
    options.profile = PioneerP3dx();
    now_ = {.vehicle = options.id, .present = true, .lives = true};
  }

  // Drives from `from` to `to` at the speed, starting at at_s; returns how often that passed red.
  int Drive(double at_s, Vec2 from, Vec2 to, double speed_m_s) {
    RedLights lights(scenario_);
    const Vec2 way = to - from;
    const auto ticks = static_cast<int>(Norm(way) / (speed_m_s * kTick_s));
    now_.forward_m_s = speed_m_s;
    int passed = 0;
    for (int i = 0; i <= ticks; ++i) {
      now_.position_world = from + (static_cast<double>(i) / ticks) * way;
      passed += static_cast<int>(lights.Observe(at_s + i * kTick_s, {&now_, 1}).size());
    }
    return passed;
  }

  Scenario scenario_;
  Observed now_;
};

TEST_F(RedLightsTest, WhoCrossesTheLineUnderRedPassesItOnce) {
  EXPECT_EQ(Drive(5, {-4, 0}, {2, 0}, 0.4), 1);
  EXPECT_EQ(Drive(12, {-1, 0.9}, {1, 0.9}, 0.4), 1);
}

TEST_F(RedLightsTest, GreenAndYellowStopNobody) {
  EXPECT_EQ(Drive(1, {-1, 0}, {1, 0}, 0.4), 0);
  EXPECT_EQ(Drive(7, {-1, 0}, {0.1, 0}, 0.4), 0);
}

TEST_F(RedLightsTest, WhoCouldNotStopWhenItTurnedRedIsExcused) {
  EXPECT_EQ(Drive(9.5, {-0.6, 0}, {1, 0}, 0.4), 0);  // its shell is 0.15 m before the line
  EXPECT_EQ(Drive(9.5, {-1.2, 0}, {1, 0}, 0.4), 1);  // 0.75 m before it
  EXPECT_EQ(Drive(9.5, {-1.7, 0}, {1, 0}, 1.0), 0);  // 0.95 m, but stopping takes 1.1 m
}

TEST_F(RedLightsTest, OnlyTrafficInItsDirectionIsMeant) {
  EXPECT_EQ(Drive(12, {1, 0}, {-1, 0}, 0.4), 0);
  EXPECT_EQ(Drive(12, {-0.5, -0.7}, {0.5, 0.7}, 0.4), 0);
  EXPECT_EQ(Drive(12, {-0.7, -0.5}, {0.7, 0.5}, 0.4), 1);
}

TEST_F(RedLightsTest, BesideTheLineThereIsNone) {
  EXPECT_EQ(Drive(12, {-1, 1.1}, {1, 1.1}, 0.4), 0);
}

TEST_F(RedLightsTest, ALightThatIsOutIsNone) {
  scenario_.faults = {{.kind = FaultKind::kSignalDark, .at_s = 11, .signal = SignalId{1}}};
  EXPECT_EQ(Drive(12, {-1, 0}, {1, 0}, 0.4), 0);
  scenario_.faults[0].at_s = 20;
  EXPECT_EQ(Drive(12, {-1, 0}, {1, 0}, 0.4), 1);
}

TEST_F(RedLightsTest, TheInvariantNamesWhoPassed) {
  Invariants invariants(scenario_, {});
  for (std::uint32_t tick = 1; tick <= 40; ++tick) {
    now_.position_world = {-0.5 + 0.02 * tick, 0};
    invariants.Observe(Tick{tick}, 12 + tick * kTick_s, {&now_, 1}, {});
  }
  EXPECT_EQ(invariants.Count(Invariant::kRedLight), 1U);
  EXPECT_EQ(invariants.First()[0].vehicle, VehicleId{1});
}

}  // namespace
}  // namespace giveway::sim

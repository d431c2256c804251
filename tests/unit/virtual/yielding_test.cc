// Which vehicle stands in the path of the one it gives way to.
#include "sim_world/virtual/yielding.h"

#include <gtest/gtest.h>

#include <vector>

#include "sim_world/virtual/invariants.h"

namespace giveway::sim {
namespace {

constexpr int kSecond = 20;  // ticks

// Vehicle 1 stands and gives way to vehicle 2, which is 2 m away and drives past through the
// origin.
class YieldingTest : public testing::Test {
 protected:
  YieldingTest() : now_(2), beacons_(2) {
    scenario_.vehicles.resize(2);
    for (std::uint32_t i = 0; i < 2; ++i) {
      scenario_.vehicles[i].id = VehicleId{i + 1};
      scenario_.vehicles[i].profile = PioneerP3dx();
      now_[i].vehicle = VehicleId{i + 1};
      now_[i].present = true;
      now_[i].lives = true;
      now_[i].beacon = &beacons_[i];
      now_[i].order = {.speed_bucket = i + 1, .vehicle = VehicleId{i + 1}};
    }
    now_[0].decision = {.rule = Rule::kGiveWay, .peer = VehicleId{2}};
    now_[1].decision = {.rule = Rule::kCruise};
    now_[1].position_world = {-2, 0};
    beacons_[0].toward_world = {0, 5};
    beacons_[1].toward_world = {3, 0};
  }
  std::size_t Stand(int ticks) {
    Yielding yielding(scenario_);
    std::size_t blocked = 0;
    for (int i = 0; i < ticks; ++i) blocked += yielding.Observe(now_).size();
    return blocked;
  }

  Scenario scenario_;
  std::vector<Observed> now_;
  std::vector<Beacon> beacons_;
};

TEST_F(YieldingTest, OneInThePathIsCountedOnceAfterItsTime) {
  EXPECT_EQ(Stand(3 * kSecond), 0U);
  EXPECT_EQ(Stand(3 * kSecond + 1), 1U);
  EXPECT_EQ(Stand(30 * kSecond), 1U);
}

TEST_F(YieldingTest, OneNextToThePathIsNot) {
  now_[0].position_world = {0, 0.5};
  EXPECT_EQ(Stand(5 * kSecond), 0U);
  now_[0].position_world = {0, 0.4};  // the bodies are 0.5 m in sum
  EXPECT_EQ(Stand(5 * kSecond), 1U);
}

TEST_F(YieldingTest, NorOneBehindItOrBeyondItsEnd) {
  now_[0].position_world = {-2.6, 0};
  EXPECT_EQ(Stand(5 * kSecond), 0U);
  now_[0].position_world = {3.1, 0};
  EXPECT_EQ(Stand(5 * kSecond), 0U);
}

TEST_F(YieldingTest, NorOneThatDrivesOrStandsForAnotherReason) {
  now_[0].forward_m_s = 0.1;
  EXPECT_EQ(Stand(5 * kSecond), 0U);
  now_[0].forward_m_s = 0;
  now_[0].decision.rule = Rule::kKeepClear;
  EXPECT_EQ(Stand(5 * kSecond), 0U);
  now_[0].decision.rule = Rule::kNotGranted;
  EXPECT_EQ(Stand(5 * kSecond), 1U);
}

TEST_F(YieldingTest, NorBeforeOneThatWillNotCome) {
  now_[1].decision.rule = Rule::kLost;
  EXPECT_EQ(Stand(5 * kSecond), 0U);
  now_[1].decision.rule = Rule::kCruise;
  now_[1].arrived = true;
  EXPECT_EQ(Stand(5 * kSecond), 0U);
  now_[1].arrived = false;
  now_[1].beacon = nullptr;
  EXPECT_EQ(Stand(5 * kSecond), 0U);
}

// The other steers round it: what two that meet head on agree on.
TEST_F(YieldingTest, NorOneThatIsMetHeadOnOrPassed) {
  beacons_[0].toward_world = {-5, 0.5};
  EXPECT_EQ(Stand(5 * kSecond), 0U);
  beacons_[0].toward_world = {-5, 4};
  EXPECT_EQ(Stand(5 * kSecond), 1U);
  now_[1].decision.rule = Rule::kSteerRound;
  EXPECT_EQ(Stand(5 * kSecond), 0U);
}

TEST_F(YieldingTest, DrivingOutOfItStartsTheTimeAgain) {
  Yielding yielding(scenario_);
  std::size_t blocked = 0;
  for (int i = 0; i < 10 * kSecond; ++i) {
    now_[0].forward_m_s = i % (2 * kSecond) == 0 ? 0.1 : 0;
    blocked += yielding.Observe(now_).size();
  }
  EXPECT_EQ(blocked, 0U);
}

// Counted among the invariants, and a failure only where asked for.
TEST_F(YieldingTest, IsAnInvariantOnRequest) {
  InvariantLimits limits;
  for (const bool required : {false, true}) {
    limits.required.set(static_cast<std::size_t>(Invariant::kYielding), required);
    Invariants invariants(scenario_, limits);
    for (std::uint32_t tick = 1; tick <= 5 * kSecond; ++tick) {
      for (std::size_t i = 0; i < 2; ++i) {
        now_[i].answered = Tick{tick};
        beacons_[i].tick = Tick{tick};
      }
      invariants.Observe(Tick{tick}, 0.05 * tick, now_, {});
    }
    EXPECT_EQ(invariants.Count(Invariant::kYielding), 1U);
    EXPECT_EQ(invariants.Broken() > 0, required);
  }
}

}  // namespace
}  // namespace giveway::sim

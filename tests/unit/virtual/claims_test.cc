// The claim of a beacon holds the body as long as the vehicle drives as its beacon said, and no
// longer.
#include "sim_world/virtual/claims.h"

#include <gtest/gtest.h>

#include <vector>

namespace giveway::sim {
namespace {

class ClaimsTest : public testing::Test {
 protected:
  ClaimsTest() {
    VehicleOptions options;
    options.id = VehicleId{1};
    options.profile = PioneerP3dx();
    scenario_.vehicles.push_back(options);
    now_.push_back({.vehicle = options.id, .present = true, .lives = true});
    beacon_.cruise_m_s = 0.3;
    beacon_.wheels = WheelsFromTwist(beacon_.drive, {0.3, 0});
  }
  // One tick of driving, by the truth; returns how many left their claims.
  std::size_t Drive(double forward_m_s, double moved_m, Claims* claims) {
    ++tick_;
    now_[0].position_world.x += moved_m;
    now_[0].forward_m_s = forward_m_s;
    beacon_.tick = Tick{tick_};
    beacon_.world_from_body = {now_[0].position_world, 0};
    now_[0].beacon = says_ ? &beacon_ : nullptr;
    return claims->Observe(Tick{tick_}, now_).size();
  }

  Scenario scenario_;
  std::vector<Observed> now_;
  Beacon beacon_;
  std::uint32_t tick_ = 0;
  bool says_ = true;
};

TEST_F(ClaimsTest, HoldForOneThatCruises) {
  Claims claims(scenario_);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(Drive(0.3, 0.015, &claims), 0U);
}

TEST_F(ClaimsTest, ALeapLeavesThem) {
  Claims claims(scenario_);
  for (int i = 0; i < 10; ++i) Drive(0.3, 0.015, &claims);
  EXPECT_EQ(Drive(0.3, 0.5, &claims), 1U);
  EXPECT_EQ(Drive(0.3, 0.015, &claims), 0U);  // reported once
}

// It is still inside, but cannot stop there.
TEST_F(ClaimsTest, OneThatCannotStopWithinLeavesThem) {
  Claims claims(scenario_);
  for (int i = 0; i < 10; ++i) Drive(0.3, 0.015, &claims);
  EXPECT_EQ(Drive(0.9, 0.03, &claims), 1U);
}

// The deviation per tick is too small for any later beacon to show: after the command to stop it
// stands where its last beacon said.
TEST_F(ClaimsTest, OneThatBrakesOnAnArcLeavesThem) {
  Claims claims(scenario_);
  for (int i = 0; i < 10; ++i) Drive(0.3, 0.015, &claims);
  now_[0].stops = true;
  std::size_t left = 0;
  for (int i = 0; i < 20; ++i) {
    now_[0].position_world.y += 0.005;
    left += Drive(0.25, 0.002, &claims);
  }
  EXPECT_EQ(left, 1U);
}

// Faster than it says, but within what it claims for being free to turn, until a second is over:
// peers that lost all later beacons keep clear of a claim for that long.
TEST_F(ClaimsTest, AnOldClaimHoldsAsLongAsPeersKeepClearOfIt) {
  Claims claims(scenario_);
  std::size_t left = 0;
  for (int i = 0; i < 18; ++i) left += Drive(0.3, 0.0445, &claims);
  EXPECT_EQ(left, 0U);
  for (int i = 0; i < 6; ++i) left += Drive(0.3, 0.0445, &claims);
  EXPECT_EQ(left, 1U);
}

// Peers that take a beacon for fresh for two seconds keep clear of its claim for as long.
TEST_F(ClaimsTest, AnOldClaimIsJudgedWhileItsBeaconMayBeFresh) {
  scenario_.vehicles[0].beacon_age_limit = std::chrono::seconds(2);
  Claims claims(scenario_);
  std::size_t left = 0;
  for (int i = 0; i < 15; ++i) left += Drive(0.3, 0.015, &claims);
  says_ = false;
  for (int i = 0; i < 25; ++i) left += Drive(0.3, 0.1, &claims);
  says_ = true;
  EXPECT_EQ(left, 0U) << "nothing is judged of one that is not heard";
  EXPECT_EQ(Drive(0.3, 0.1, &claims), 1U);
}

TEST_F(ClaimsTest, NothingIsJudgedOfOneThatIsNotHeard) {
  says_ = false;
  Claims claims(scenario_);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(Drive(0.3, 1, &claims), 0U);
}

}  // namespace
}  // namespace giveway::sim

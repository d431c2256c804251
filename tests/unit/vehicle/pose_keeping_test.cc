// How a vehicle keeps its pose: fixes weighted, late and refused; wheel errors that fixes
// reveal; and when it is uncertain, lost and found.
#include "services/vehicle/estimation/pose_keeping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/types/math/math.h"
#include "tests/support/pose_keeper.h"

namespace giveway {
namespace {

using test::Fitted;
using test::kAhead;
using test::kBend;
using test::kDt_s;
using test::Keeper;
using test::kOwn;
using test::kSigma_m;

// That a fix at that squared distance, in deviations, is right: a normal density against the same
// anywhere within the gate.
double Probably(double distance2, double wrong_share) {
  const double right = (1 - wrong_share) * std::exp(-distance2 / 2) / (2 * kPi);
  const double wrong = wrong_share / (kPi * 13.8);
  return right / (right + wrong);
}

TEST(PoseKeeping, AFixIsWeighedByWhatBothKnow) {
  Keeper keeper(Fitted());
  keeper.odometry = Odometry({}, {.xx_m2 = 0.01, .yy_m2 = 0.01});  // 0.1 m unsure
  keeper.Drive({});
  keeper.Drive({});
  keeper.Give(keeper.FixOf(2, {0.08, 0}));
  keeper.Drive({});
  const double share = 0.01 / (0.01 + kSigma_m * kSigma_m);
  const double right = Probably(0.08 * 0.08 / (0.01 + kSigma_m * kSigma_m), 0.03);
  EXPECT_NEAR(keeper.odometry.WorldFromBody().position_world.x, right * share * 0.08, 1e-12);
  const double apart_m2 = right * (1 - right) * share * share * 0.08 * 0.08;
  EXPECT_NEAR(keeper.odometry.Covariance().xx_m2, (1 - right * share) * 0.01 + apart_m2, 1e-12);
  EXPECT_EQ(keeper.keeping.fixes_used, 1U);
}

TEST(PoseKeeping, AFixOfThePositionAlsoRightsTheHeadingThatLedThere) {
  Keeper keeper(Fitted(0.1));
  for (int i = 0; i < 60; ++i) keeper.Drive(kAhead);
  const double before = SigmaHeading(keeper.odometry.Covariance());
  keeper.Give(keeper.FixOf(keeper.tick));
  keeper.Drive(kAhead);
  EXPECT_LT(SigmaHeading(keeper.odometry.Covariance()), 0.9 * before);
}

// Of one that was 0.2 rad unsure of its heading, which is 0.
double HeadingAfterAFix(double heading_rad, double sigma_rad) {
  Keeper keeper(Fitted());
  keeper.odometry = Odometry({}, {.hh_rad2 = 0.04});
  keeper.Drive({});
  keeper.Drive({});
  PoseFix fix = keeper.FixOf(2);
  fix.world_from_body.heading_rad = heading_rad;
  fix.sigma_heading_rad = sigma_rad;
  keeper.Give(fix);
  keeper.Drive({});
  return keeper.odometry.WorldFromBody().heading_rad;
}

TEST(PoseKeeping, AFixOfTheHeadingRightsIt) { EXPECT_NEAR(HeadingAfterAFix(0.2, 0.2), 0.1, 1e-3); }

TEST(PoseKeeping, AHeadingFarOffHardlyCounts) {
  EXPECT_GT(HeadingAfterAFix(0.3, 0.1), 0.2);
  EXPECT_LT(HeadingAfterAFix(0.7, 0.1), 0.5);
}

TEST(PoseKeeping, AFixIsUsedFromTheTickAfterItsOwnOn) {
  Keeper keeper(Fitted());
  keeper.odometry = Odometry({}, {.xx_m2 = 0.01, .yy_m2 = 0.01});
  keeper.Drive({});
  keeper.Drive({});
  keeper.Give(keeper.FixOf(2, {0.1, 0}));
  EXPECT_EQ(keeper.odometry.WorldFromBody().position_world.x, 0);
  keeper.Drive({});
  EXPECT_GT(keeper.odometry.WorldFromBody().position_world.x, 0.05);
}

// A fix ten ticks late says where the vehicle was, not where it is.
TEST(PoseKeeping, ALateFixIsComparedWithWhereItWasThen) {
  Keeper keeper(Fitted());
  keeper.odometry = Odometry({}, {.xx_m2 = 0.01, .yy_m2 = 0.01});
  for (int i = 0; i < 30; ++i) keeper.Drive(kBend);
  keeper.Give(keeper.FixOf(20));
  EXPECT_EQ(keeper.keeping.fixes_used, 1U);
  EXPECT_LT(keeper.Off(), 1e-9);
}

TEST(PoseKeeping, AFixOfTooLongAgoOrFromAnotherWorldIsRefused) {
  Keeper keeper(Fitted());
  for (int i = 0; i < 40; ++i) keeper.Drive(kAhead);
  keeper.Give(keeper.FixOf(40 - kPastPoses));
  EXPECT_EQ(keeper.keeping.fixes_refused, 1U);
  PoseFix other = keeper.FixOf(39);
  other.epoch = WorldEpoch{8};
  keeper.Give(other);
  other = keeper.FixOf(39);
  other.vehicle = VehicleId{2};
  keeper.Give(other);
  EXPECT_EQ(keeper.keeping.fixes_refused, 3U);
  EXPECT_EQ(keeper.keeping.fixes_used, 0U);
}

TEST(PoseKeeping, TheSameFixTwiceCountsOnce) {
  Keeper keeper(Fitted(0.1));
  for (int i = 0; i < 30; ++i) keeper.Drive(kAhead);
  keeper.Give(keeper.FixOf(29));
  const double sigma_m = keeper.Sigma();
  keeper.Give(keeper.FixOf(29));
  EXPECT_EQ(keeper.Sigma(), sigma_m);
  EXPECT_EQ(keeper.keeping.fixes_used, 1U);
}

TEST(PoseKeeping, AFixThatIsNoneChangesNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Keeper keeper(Fitted(0.1));
  for (int i = 0; i < 30; ++i) keeper.Drive(kAhead);
  const Pose before = keeper.odometry.WorldFromBody();
  for (const double bad : {kNan, 0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    PoseFix fix = keeper.FixOf(29);
    fix.sigma_position_m = bad;
    keeper.Give(fix);
  }
  PoseFix nowhere = keeper.FixOf(29, {kNan, 0});
  keeper.Give(nowhere);
  EXPECT_EQ(keeper.odometry.WorldFromBody(), before);
  EXPECT_EQ(keeper.keeping.fixes_refused, 5U);
}

// Deviations whose squares underflow, from a pose that is known exactly.
TEST(PoseKeeping, AFixThatClaimsToBeExactIsRefused) {
  for (const double sigma : {1e-200, 1e-170, 1e-7, 1e4, 1e300}) {
    Keeper keeper(Fitted());
    keeper.Drive({});
    keeper.Drive({});
    PoseFix fix = keeper.FixOf(1);
    fix.sigma_position_m = sigma;
    keeper.Give(fix);
    fix = keeper.FixOf(1);
    fix.sigma_heading_rad = sigma;
    keeper.Give(fix);
    EXPECT_EQ(keeper.keeping.fixes_used, 0U) << sigma;
    EXPECT_EQ(keeper.keeping.fixes_refused, 2U) << sigma;
    EXPECT_EQ(keeper.odometry.WorldFromBody(), Pose{}) << sigma;
  }
}

// A fix that waits came from a snapshot, and is not checked yet.
TEST(PoseKeeping, AFixThatWaitedIsLookedAtLikeAnyOther) {
  Keeper keeper(Fitted());
  keeper.Drive({});
  keeper.keeping.waiting = keeper.FixOf(1);
  keeper.keeping.waiting.sigma_position_m = 1e-200;
  keeper.Drive({});
  EXPECT_EQ(keeper.keeping.fixes_used, 0U);
  EXPECT_EQ(keeper.odometry.WorldFromBody(), Pose{});
}

// The error of a step has one model: with fixes too the encoders are not taken for exact.
TEST(PoseKeeping, SaysWhatAWayAddsToTheDoubt) {
  const auto added = [](const RobotModel& profile) {
    Odometry odometry;
    PoseKeeping keeping;
    Begin(profile, &keeping);
    const PoseCovariance said =
        Roll(profile, {.wheels = kBend, .dt_s = kDt_s, .tick = Tick{1}}, &odometry, &keeping);
    EXPECT_EQ(said, odometry.Covariance());
    return said.xx_m2;
  };
  EXPECT_EQ(added(PioneerP3dx()), 0);
  EXPECT_GT(added(Fitted()), 0);
}

// Over a hundred robots, 60 s each, the filter's covariance matches its error.
TEST(PoseKeeping, ItsErrorStaysAsSmallAsItSays) {
  double squares = 0;
  int samples = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Keeper keeper(Fitted(0.1), seed);
    for (int i = 1; i <= 1200; ++i) {
      keeper.Drive(i / 100 % 2 == 0 ? kBend : kAhead);
      if (i % 20 == 0) keeper.Give(keeper.NoisyFix());
      if (i % 60 != 0) continue;
      squares += std::pow(keeper.Off() / keeper.Sigma(), 2);
      ++samples;
    }
    EXPECT_LT(keeper.Off(), 0.3) << seed;
  }
  // Two numbers along the worst axis each: at most 2, and not far from it.
  EXPECT_GT(squares / samples, 0.5);
  EXPECT_LT(squares / samples, 2.5);
}

// As the fault encoder_wrong does: undetectable by wheels alone, within the allowance of others
// with fixes.
TEST(PoseKeeping, EncodersThatCountALittleTooMuchAreMadeGoodByFixes) {
  Keeper keeper(Fitted());
  for (int i = 0; i < 400; ++i) {
    keeper.Drive(kAhead, 1.02);
    if (i % 20 == 19) keeper.Give(keeper.NoisyFix());
    ASSERT_LE(keeper.Off(), 3 * keeper.Sigma() + 0.1) << i;
  }
}

TEST(PoseKeeping, UnequalWheelsAreLearntFromFixes) {
  RobotModel profile = Fitted();
  profile.wheel_error = {.diameter = 0.03, .axle = -0.05};
  Keeper keeper(profile);
  for (int i = 1; i <= 2400; ++i) {
    keeper.Drive(i / 200 % 2 == 0 ? WheelSpeeds{2, 4} : WheelSpeeds{4.2, 2.4});
    if (i % 20 == 0) keeper.Give(keeper.NoisyFix());
    ASSERT_LE(keeper.Off(), 3 * keeper.Sigma() + 0.1) << i;
  }
  EXPECT_NEAR(keeper.keeping.calibration.wheels.diameter, 0.03, 0.006);
  EXPECT_NEAR(keeper.keeping.calibration.wheels.axle, -0.05, 0.012);
}

// It knows the size of its wheel errors, not their sign.
TEST(PoseKeeping, TheSignOfAWheelErrorIsNotKnownToIt) {
  RobotModel one = Fitted();
  one.wheel_error = {.diameter = 0.03, .axle = -0.05};
  RobotModel other = one;
  other.wheel_error = {.diameter = -0.03, .axle = 0.05};
  Odometry odometry_of_one, odometry_of_other;
  PoseKeeping keeping_of_one, keeping_of_other;
  Begin(one, &keeping_of_one);
  Begin(other, &keeping_of_other);
  for (std::uint32_t tick = 1; tick < 100; ++tick) {
    const Rolling rolling{.wheels = kBend, .dt_s = kDt_s, .tick = Tick{tick}};
    Roll(one, rolling, &odometry_of_one, &keeping_of_one);
    Roll(other, rolling, &odometry_of_other, &keeping_of_other);
  }
  EXPECT_EQ(odometry_of_one.WorldFromBody(), odometry_of_other.WorldFromBody());
  EXPECT_EQ(odometry_of_one.Covariance(), odometry_of_other.Covariance());
}

// Its error grows with the distance, not with the square root of it.
TEST(PoseKeeping, WithoutFixesTheDoubtOfUnequalWheelsGrowsAsTheirErrorDoes) {
  RobotModel profile = PioneerP3dx();
  profile.wheel_error = {.diameter = 0.02, .axle = 0.02};
  Keeper keeper(profile);
  for (int i = 0; i < 200; ++i) {
    keeper.Drive(kBend);
    ASSERT_LE(keeper.Off(), 2 * keeper.Sigma() + 1e-6) << i;
  }
  EXPECT_GT(keeper.Off(), 0.3 * keeper.Sigma());
}

TEST(PoseKeeping, WithoutAnyOfItDeadReckoningIsWhatItWas) {
  RobotModel profile = PioneerP3dx();
  profile.wheel_slip = 0.1;
  Keeper keeper(profile);
  Odometry plain;
  for (int i = 0; i < 300; ++i) {
    keeper.Drive(kBend);
    plain.Roll(profile.drive, kBend, kDt_s, 0.1, 0);
  }
  EXPECT_EQ(keeper.odometry.WorldFromBody(), plain.WorldFromBody());
  EXPECT_EQ(keeper.odometry.Covariance(), plain.Covariance());
  EXPECT_FALSE(KeepsPose(profile));
  EXPECT_EQ(keeper.Share(), 1);
}

TEST(PoseKeeping, OneThatGrowsUnsureSlowsDownThenIsLostAndFoundByAFix) {
  Keeper keeper(Fitted(0.1));
  double share = 1;
  bool slowed = false;
  while (share > 0 && keeper.tick < 4000) {
    keeper.Drive(kAhead);
    share = keeper.Share();
    slowed = slowed || (share > 0 && share < 1);
    if (share == 1) {
      EXPECT_LE(keeper.Sigma(), 0.6 * kUsualPoseLimit_m + 1e-9);
    }
  }
  EXPECT_TRUE(slowed);
  ASSERT_TRUE(keeper.keeping.lost);
  EXPECT_GE(keeper.Sigma(), kUsualPoseLimit_m);
  keeper.Drive({});
  EXPECT_EQ(keeper.Share(), 0) << "a standing vehicle learns nothing";
  keeper.Give(keeper.NoisyFix());
  keeper.Drive({});
  EXPECT_EQ(keeper.Share(), 1);
  EXPECT_FALSE(keeper.keeping.lost);
}

TEST(PoseKeeping, AtTheEdgeOfItsLimitItDoesNotFlutter) {
  RobotModel profile = Fitted();
  PoseKeeping keeping;
  const auto share = [&](double sigma_m) {
    return JudgeCertainty(profile, {.xx_m2 = sigma_m * sigma_m}, &keeping);
  };
  EXPECT_GT(share(0.29), 0);
  EXPECT_EQ(share(0.31), 0);
  EXPECT_EQ(share(0.29), 0);
  EXPECT_EQ(share(0.24), 0);
  EXPECT_GT(share(0.2), 0);
}

// Ten thousand fixes and turns: rounding must never make a variance negative.
TEST(PoseKeeping, StaysUnsureWithinReason) {
  RobotModel profile = Fitted(0.1);
  profile.wheel_error = {.diameter = 0.01, .axle = 0.01};
  Keeper keeper(profile);
  Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    keeper.Drive({random.Uniform(-5, 5), random.Uniform(-5, 5)});
    if (i % 7 == 0) keeper.Give(keeper.NoisyFix());
    const PoseCovariance c = keeper.odometry.Covariance();
    ASSERT_TRUE(c.xx_m2 >= 0 && c.yy_m2 >= 0 && c.hh_rad2 >= 0) << i;
    ASSERT_TRUE(keeper.Sigma() < 0.5) << i;
    ASSERT_GE(c.xx_m2 * c.yy_m2 - c.xy_m2 * c.xy_m2, -1e-12) << i;
  }
}

}  // namespace
}  // namespace giveway

// What a vehicle makes of pose fixes that do not fit, and of those that fit where others did not.
#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "services/vehicle/estimation/pose_keeping.h"
#include "tests/support/pose_keeper.h"

namespace giveway {
namespace {

using test::Fitted;
using test::kAhead;
using test::Keeper;
using test::kSigma_m;

// Right fixes, perhaps none for a while, then wrong ones.
struct Course {
  int silent_from = 200;
  int silent_to = 200;
  int ticks = 0;
};

// In 400 courses. As the fault pose_fix_wrong of config/faults/everything.textproto: half of the
// fixes come off a wall, 8 of their deviations to any side. Judged as the invariant "pose" does.
int BreaksAmongWrongFixes(const Course& course) {
  constexpr double kSlack_m = 0.1;
  RobotModel profile = Fitted();
  profile.pose_fix.every_s = 0.5;
  int broken = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Keeper keeper(profile, seed);
    Random random(1000 + seed);
    WheelSpeeds wheels;
    for (int i = 0; i < course.ticks; ++i) {
      if (i % 20 == 0) wheels = {random.Uniform(1, 5), random.Uniform(1, 5)};
      keeper.Drive(wheels);
      if (i % 10 != 0 || (i > course.silent_from && i < course.silent_to)) continue;
      PoseFix fix = keeper.NoisyFix();
      if (i > course.silent_from && random.Uniform(0, 1) < 0.5) {
        const double side_rad = random.Uniform(-kPi, kPi);
        fix.world_from_body.position_world =
            fix.world_from_body.position_world + 8 * kSigma_m * Vec2{Cos(side_rad), Sin(side_rad)};
      }
      keeper.Give(fix);
      broken += keeper.Off() > 3 * keeper.Sigma() + kSlack_m ? 1 : 0;
    }
  }
  return broken;
}

// At the rim of the gate, where a wrong one is more likely.
TEST(PoseKeeping, AFixFarOffHardlyCounts) {
  Keeper keeper(Fitted());
  keeper.odometry = Odometry({}, {.xx_m2 = 0.01, .yy_m2 = 0.01});
  keeper.Drive({});
  keeper.Drive({});
  keeper.Give(keeper.FixOf(2, {0.38, 0}));
  keeper.Drive({});
  EXPECT_EQ(keeper.keeping.fixes_used, 1U);
  EXPECT_LT(keeper.odometry.WorldFromBody().position_world.x, 0.2);
  EXPECT_GT(keeper.odometry.Covariance().xx_m2, 0.01);
}

// Where many do not fit, one that does may be wrong as well.
TEST(PoseKeeping, AFixAmongWrongOnesCountsForLess) {
  const auto moved = [](int wrong, int right = 0) {
    Keeper keeper(Fitted());
    keeper.odometry = Odometry({}, {.xx_m2 = 0.01, .yy_m2 = 0.01});
    keeper.Drive({});
    for (int i = 0; i < wrong; ++i) {
      keeper.Drive({});
      keeper.Give(keeper.FixOf(keeper.tick, {i % 2 == 0 ? 1.0 : -1.0, 1}));
    }
    for (int i = 0; i < right; ++i) {
      keeper.Drive({});
      keeper.Give(keeper.FixOf(keeper.tick));
    }
    keeper.Drive({});
    keeper.odometry = Odometry({}, {.xx_m2 = 0.01, .yy_m2 = 0.01});
    keeper.Drive({});
    const std::uint32_t before = keeper.keeping.fixes_used;
    keeper.Give(keeper.FixOf(keeper.tick, {0.2, 0}));
    keeper.Drive({});
    EXPECT_EQ(keeper.keeping.fixes_used, before + 1);
    return keeper.odometry.WorldFromBody().position_world.x;
  };
  EXPECT_GT(moved(0), 0.15);
  EXPECT_LT(moved(6), 0.12);
  EXPECT_GT(moved(6, 30), 0.15);
}

// A sensor that was silent for long did not work, and may not work yet.
TEST(PoseKeeping, AFixAfterALongSilenceCountsForLess) {
  const auto moved = [](int silent_ticks) {
    Keeper keeper(Fitted());
    for (int i = 0; i < 20; ++i) keeper.Drive({});
    keeper.Give(keeper.FixOf(keeper.tick));
    for (int i = 0; i < silent_ticks; ++i) keeper.Drive({});
    keeper.odometry = Odometry({}, {.xx_m2 = 0.01, .yy_m2 = 0.01});
    keeper.Drive({});
    keeper.Give(keeper.FixOf(keeper.tick, {0.2, 0}));
    keeper.Drive({});
    EXPECT_EQ(keeper.keeping.fixes_used, 2U);
    return keeper.odometry.WorldFromBody().position_world.x;
  };
  EXPECT_GT(moved(18), 0.15);
  EXPECT_LT(moved(20 * 30), 0.12);
}

// As where pose_fix_lost ends while pose_fix_wrong lasts.
TEST(PoseKeeping, SaysHowFarItMayBeOffWhereFixesComeBackWrong) {
  EXPECT_LE(BreaksAmongWrongFixes({.silent_to = 440, .ticks = 800}), 1);
}

TEST(PoseKeeping, AHeadingThatDoesNotFitIsDoubtedToo) {
  Keeper keeper(Fitted());
  keeper.odometry = Odometry({}, {.xx_m2 = 0.0001, .yy_m2 = 0.0001, .hh_rad2 = 0.0001});
  for (int i = 0; i < 3; ++i) keeper.Drive({});
  const auto turned = [&](double off_rad) {
    PoseFix fix = keeper.FixOf(keeper.tick - 1);
    fix.world_from_body.heading_rad += off_rad;
    fix.sigma_heading_rad = 0.05;
    return fix;
  };
  keeper.Give(turned(0.5));
  EXPECT_EQ(keeper.keeping.disagreement.fixes, 1U);
  EXPECT_NEAR(SigmaHeading(PromisedCovariance(keeper.odometry, keeper.keeping)), 0.5, 0.01);
  keeper.Drive({});
  keeper.Give(turned(-0.5));
  EXPECT_EQ(keeper.keeping.disagreement.fixes, 1U) << "they do not agree";
  for (int i = 0; i < 7; ++i) {
    keeper.Drive({});
    keeper.Give(turned(-0.5));
  }
  EXPECT_EQ(keeper.keeping.fixes_used, 1U);
  EXPECT_NEAR(keeper.odometry.WorldFromBody().heading_rad, -0.5, 0.05);
}

// One outlier does not move the vehicle; until the next fix it reports that it may be there.
TEST(PoseKeeping, AnOutlierIsDoubtedAndNotFollowed) {
  Keeper keeper(Fitted());
  for (int i = 0; i < 200; ++i) {
    keeper.Drive(kAhead);
    if (i % 20 == 10) keeper.Give(keeper.NoisyFix());
  }
  const double sigma_m = keeper.Sigma();
  keeper.Give(keeper.FixOf(keeper.tick, {0, 0.6}));
  keeper.Drive(kAhead);
  EXPECT_LT(keeper.Off(), 0.1);
  EXPECT_GT(keeper.Sigma(), 0.5);
  EXPECT_EQ(keeper.keeping.fixes_refused, 1U);
  keeper.Give(keeper.NoisyFix());
  keeper.Drive(kAhead);
  EXPECT_LT(keeper.Sigma(), 1.2 * sigma_m);
}

TEST(PoseKeeping, SaysHowFarItMayBeOffWhereHalfOfTheFixesAreWrong) {
  EXPECT_EQ(BreaksAmongWrongFixes({.ticks = 800}), 0);
}

TEST(PoseKeeping, AFixWhereNoWheelsCanHaveBroughtItIsPassedOver) {
  Keeper keeper(Fitted());
  for (int i = 0; i < 40; ++i) {
    keeper.Drive(kAhead);
    if (i % 20 == 10) keeper.Give(keeper.NoisyFix());
  }
  const double sigma_m = keeper.Sigma();
  keeper.Give(keeper.FixOf(keeper.tick - 1, {20, 0}));
  EXPECT_EQ(keeper.Sigma(), sigma_m);
  EXPECT_EQ(keeper.keeping.fixes_refused, 1U);
}

// Encoders that count a third too much: fixes are doubted, then accepted.
TEST(PoseKeeping, FixesThatAgreeAreBelievedAgainstTheWheels) {
  Keeper keeper(Fitted());
  for (int i = 0; i < 40; ++i) {
    keeper.Drive(kAhead, 2.5);
    const Vec2 off = keeper.odometry.WorldFromBody().position_world - keeper.truth.position_world;
    ASSERT_LE(Norm(off), 3 * keeper.Sigma() + 0.6) << i;
    if (i % 20 == 19) keeper.Give(keeper.NoisyFix());
  }
  EXPECT_GT(keeper.keeping.disagreement.fixes, 0U);
  for (int i = 0; i < 160; ++i) {
    keeper.Drive({});
    if (i % 20 == 19) keeper.Give(keeper.NoisyFix());
  }
  EXPECT_EQ(keeper.keeping.disagreement.fixes, 0U);
  EXPECT_LT(keeper.Off(), 0.15);
}

}  // namespace
}  // namespace giveway

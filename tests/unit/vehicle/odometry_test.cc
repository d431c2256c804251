// The filter against what it models: many robots with wheels as wrong as it is told, and fixes as
// wrong as they say.
#include "services/vehicle/estimation/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway {
namespace {

constexpr double kDt_s = 0.05;
constexpr double kWheelError = 0.1;
constexpr WheelSpeeds kWheels = {3.0, 3.4};  // a wide left turn
constexpr int kTicks = 200;

Odometry Rolled(int ticks) {
  Odometry odometry;
  for (int i = 0; i < ticks; ++i) odometry.Roll({}, kWheels, kDt_s, kWheelError, 0);
  return odometry;
}

TEST(Odometry, RollsAlongTheArcOfItsWheels) {
  Pose expected;
  for (int i = 0; i < kTicks; ++i)
    expected = AdvanceArc(expected, TwistFromWheels({}, kWheels), kDt_s);
  EXPECT_EQ(Rolled(kTicks).WorldFromBody(), expected);
}

TEST(Odometry, WithoutErrorItStaysCertain) {
  Odometry odometry;
  for (int i = 0; i < kTicks; ++i) odometry.Roll({}, kWheels, kDt_s, 0, 0);
  EXPECT_EQ(SigmaPosition(odometry.Covariance()), 0);
  EXPECT_EQ(SigmaHeading(odometry.Covariance()), 0);
}

TEST(Odometry, ItsErrorIsThatOfManyRobotsWithSuchWheels) {
  constexpr int kRobots = 4000;
  const Odometry filter = Rolled(kTicks);
  Random random(1);
  double worst_axis = 0;
  double heading = 0;
  double xx = 0, xy = 0, yy = 0;
  for (int robot = 0; robot < kRobots; ++robot) {
    Pose pose;
    for (int i = 0; i < kTicks; ++i) {
      const WheelSpeeds really = {kWheels.left_rad_s * (1 + random.Gaussian(kWheelError)),
                                  kWheels.right_rad_s * (1 + random.Gaussian(kWheelError))};
      pose = AdvanceArc(pose, TwistFromWheels({}, really), kDt_s);
    }
    const Vec2 off = pose.position_world - filter.WorldFromBody().position_world;
    const double turn = WrapAngle(pose.heading_rad - filter.WorldFromBody().heading_rad);
    xx += off.x * off.x / kRobots;
    xy += off.x * off.y / kRobots;
    yy += off.y * off.y / kRobots;
    heading += turn * turn / kRobots;
  }
  worst_axis = (xx + yy) / 2 + std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
  EXPECT_NEAR(SigmaPosition(filter.Covariance()), std::sqrt(worst_axis),
              0.05 * std::sqrt(worst_axis));
  EXPECT_NEAR(SigmaHeading(filter.Covariance()), std::sqrt(heading), 0.05 * std::sqrt(heading));
}

TEST(Odometry, TicksThatAreGuessedCostCertainty) {
  Odometry odometry;
  odometry.Roll({}, kWheels, kDt_s, 0, 0.02);
  EXPECT_NEAR(SigmaPosition(odometry.Covariance()), 0.02, 1e-12);
}

TEST(Odometry, AFixIsWeighedByWhatBothKnow) {
  Odometry odometry;
  odometry.Roll({}, {}, kDt_s, 0, 0.1);  // at the origin, 0.1 m uncertain
  ASSERT_TRUE(odometry.Fix({{{0.2, 0}, 0}, 0.1, 1}));
  EXPECT_NEAR(odometry.WorldFromBody().position_world.x, 0.1, 1e-12);
  EXPECT_NEAR(SigmaPosition(odometry.Covariance()), 0.1 / std::sqrt(2.0), 1e-12);
}

TEST(Odometry, AFixOfThePositionAlsoRightsTheHeadingThatLedThere) {
  Odometry odometry = Rolled(kTicks);
  const double before = SigmaHeading(odometry.Covariance());
  ASSERT_TRUE(odometry.Fix({odometry.WorldFromBody(), 0.01, 10}));
  EXPECT_LT(SigmaHeading(odometry.Covariance()), 0.9 * before);
  EXPECT_LE(SigmaPosition(odometry.Covariance()), 0.01);
}

TEST(Odometry, AFixThatIsNoneChangesNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const PoseFix& fix :
       {PoseFix{{{kNan, 0}, 0}, 1, 1}, PoseFix{{{1, 0}, kNan}, 1, 1}, PoseFix{{{1, 0}, 0}, 0, 1},
        PoseFix{{{1, 0}, 0}, 1, -1}, PoseFix{{{1, 0}, 0}, kNan, 1}}) {
    Odometry odometry = Rolled(10);
    const Pose before = odometry.WorldFromBody();
    const double sigma = SigmaPosition(odometry.Covariance());
    EXPECT_FALSE(odometry.Fix(fix));
    EXPECT_EQ(odometry.WorldFromBody(), before);
    EXPECT_EQ(SigmaPosition(odometry.Covariance()), sigma);
  }
}

// Ten thousand fixes and turns: rounding must never make a variance negative.
TEST(Odometry, StaysCertainAndUncertainWithinReason) {
  Odometry odometry;
  Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    odometry.Roll({}, {random.Uniform(-5, 5), random.Uniform(-5, 5)}, kDt_s, kWheelError, 0);
    if (i % 7 == 0) odometry.Fix({odometry.WorldFromBody(), 0.02, 0.01});
    ASSERT_TRUE(SigmaPosition(odometry.Covariance()) >= 0 &&
                SigmaPosition(odometry.Covariance()) < 0.2)
        << i;
    ASSERT_TRUE(SigmaHeading(odometry.Covariance()) >= 0 &&
                SigmaHeading(odometry.Covariance()) < 0.2)
        << i;
  }
}

}  // namespace
}  // namespace giveway

// Dead reckoning against its error model: many robots with wheel errors of the configured size.
#include "services/vehicle/estimation/odometry.h"

#include <gtest/gtest.h>

#include <cmath>

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

// Ten thousand turns: rounding must never make a variance negative.
TEST(Odometry, StaysUncertainWithinReason) {
  Odometry odometry;
  Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    odometry.Roll({}, {random.Uniform(-5, 5), random.Uniform(-5, 5)}, kDt_s, kWheelError, 0);
    const PoseCovariance c = odometry.Covariance();
    ASSERT_TRUE(c.xx_m2 >= 0 && c.yy_m2 >= 0 && c.hh_rad2 >= 0 && c.hh_rad2 < 30) << i;
  }
}

}  // namespace
}  // namespace giveway

#include "services/types/math/pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway {
namespace {

TEST(Pose, WheelsAndTwistAreEachOthersInverse) {
  const DriveGeometry drive;
  const Twist twist = TwistFromWheels(drive, {.left_rad_s = 2, .right_rad_s = 3});
  EXPECT_NEAR(twist.forward_m_s, 0.0975 * 2.5, 1e-15);
  EXPECT_NEAR(twist.turn_rad_s, 0.0975 / 0.33, 1e-15);
  const WheelSpeeds back = WheelsFromTwist(drive, twist);
  EXPECT_NEAR(back.left_rad_s, 2, 1e-12);
  EXPECT_NEAR(back.right_rad_s, 3, 1e-12);
}

// Half a circle of radius 1 counter-clockwise from the origin ends 2 m to the left, facing back.
TEST(Pose, AnArcIsExactInOneStep) {
  const Pose end = AdvanceArc({}, {.forward_m_s = kPi, .turn_rad_s = kPi}, 1.0);
  EXPECT_NEAR(end.position_world.x, 0, 1e-12);
  EXPECT_NEAR(end.position_world.y, 2, 1e-12);
  EXPECT_NEAR(end.heading_rad, kPi, 1e-12);
}

TEST(Pose, OneStepEqualsAThousandSmallOnes) {
  const Pose start{.position_world = {1, -2}, .heading_rad = 0.7};
  const Twist twist{.forward_m_s = 0.4, .turn_rad_s = -0.9};
  Pose small = start;
  for (int i = 0; i < 1000; ++i) small = AdvanceArc(small, twist, 0.002);
  const Pose once = AdvanceArc(start, twist, 2.0);
  EXPECT_NEAR(once.position_world.x, small.position_world.x, 1e-10);
  EXPECT_NEAR(once.position_world.y, small.position_world.y, 1e-10);
  EXPECT_NEAR(once.heading_rad, small.heading_rad, 1e-10);
}

TEST(Pose, TheStraightLineLimitIsSmooth) {
  const Pose straight = AdvanceArc({}, {.forward_m_s = 1, .turn_rad_s = 0}, 1.0);
  const Pose nearly = AdvanceArc({}, {.forward_m_s = 1, .turn_rad_s = 1e-9}, 1.0);
  EXPECT_EQ(straight.position_world.x, 1);
  EXPECT_NEAR(nearly.position_world.x, 1, 1e-15);
  EXPECT_NEAR(nearly.position_world.y, 5e-10, 1e-15);
}

TEST(Pose, BodyAndWorldFramesAreInverse) {
  const Pose pose{.position_world = {3, 4}, .heading_rad = 2.1};
  const Vec2 back = ToBody(pose, ToWorld(pose, {0.3, -0.2}));
  EXPECT_NEAR(back.x, 0.3, 1e-12);
  EXPECT_NEAR(back.y, -0.2, 1e-12);
}

TEST(Facing, AdvancesAsThePoseDoes) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Pose start{.position_world = {random.Uniform(-5, 5), random.Uniform(-5, 5)},
                     .heading_rad = random.Uniform(-3, 3)};
    const Twist twist{.forward_m_s = random.Uniform(-1, 1),
                      .turn_rad_s = i % 10 == 0 ? 0 : random.Uniform(-2, 2)};
    const double dt_s = i % 7 == 0 ? 1e-5 : random.Uniform(0, 2);
    const Pose pose = AdvanceArc(start, twist, dt_s);
    const Facing facing = AdvanceFacing({start.position_world, Forward(start)}, twist, dt_s);
    EXPECT_NEAR(facing.position_world.x, pose.position_world.x, 1e-11) << i;
    EXPECT_NEAR(facing.position_world.y, pose.position_world.y, 1e-11) << i;
    EXPECT_NEAR(facing.forward_world.x, Forward(pose).x, 1e-11) << i;
    EXPECT_NEAR(facing.forward_world.y, Forward(pose).y, 1e-11) << i;
  }
}

TEST(PoseCovariance, IsCarriedOnWithTheErrorOfTheHeading) {
  const PoseCovariance start{0.04, 0.01, 0.02, 0.002, -0.003, 0.01};
  const Vec2 way{3, -2};
  const PoseCovariance end = Carried(start, way);
  // An error (x, y, h) of the start becomes (x + 2 h, y + 3 h, h): by the variances of those
  // sums, term by term.
  EXPECT_NEAR(end.xx_m2, 0.04 + 2 * 2 * 0.002 + 4 * 0.01, 1e-15);
  EXPECT_NEAR(end.yy_m2, 0.02 + 2 * 3 * -0.003 + 9 * 0.01, 1e-15);
  EXPECT_NEAR(end.xy_m2, 0.01 + 3 * 0.002 + 2 * -0.003 + 6 * 0.01, 1e-15);
  EXPECT_NEAR(end.xh_m_rad, 0.002 + 2 * 0.01, 1e-15);
  EXPECT_NEAR(end.yh_m_rad, -0.003 + 3 * 0.01, 1e-15);
  EXPECT_EQ(end.hh_rad2, 0.01);
}

TEST(PoseCovariance, IsWorstAlongItsLongAxis) {
  // 0.3 m along the diagonal, 0.1 m across it.
  const PoseCovariance c{.xx_m2 = 0.05, .xy_m2 = 0.04, .yy_m2 = 0.05};
  const double half = Sqrt(0.5);
  EXPECT_NEAR(SigmaPosition(c), 0.3, 1e-12);
  EXPECT_NEAR(SigmaAlong(c, {half, half}), 0.3, 1e-12);
  EXPECT_NEAR(SigmaAlong(c, {half, -half}), 0.1, 1e-12);
  EXPECT_NEAR(SigmaAlong(c, {1, 0}), Sqrt(0.05), 1e-12);
}

TEST(PoseCovariance, ThatCannotBeIsNoNegativeRoot) {
  EXPECT_EQ(SigmaAlong({.xx_m2 = 0.01, .xy_m2 = -1, .yy_m2 = 0.01}, {Sqrt(0.5), Sqrt(0.5)}), 0);
}

TEST(CachedHeading, FollowsEveryChangeOfTheHeading) {
  CachedHeading known;
  for (const double heading_rad : {0.0, 0.3, 0.3, -2.0, kPi, 0.0, -0.0}) {
    const Pose pose{{1, 2}, heading_rad};
    known.Follow(pose);
    EXPECT_EQ(known.forward_world, Forward(pose)) << heading_rad;
    EXPECT_EQ(std::signbit(known.forward_world.y), std::signbit(Forward(pose).y)) << heading_rad;
  }
}

TEST(CachedBearing, IsTheHeadingAlongWhateverDirectionIsAskedFor) {
  CachedBearing known;
  for (const Vec2 direction : {Vec2{1, 0}, {0, 1}, {0, 1}, {0, -1}, {-1, 0}, {0.6, 0.8}, {1, 0}}) {
    EXPECT_EQ(known.Of(direction), Atan2(direction.y, direction.x))
        << direction.x << ' ' << direction.y;
  }
}

TEST(AdvanceArc, WithAKnownHeadingItEndsOnTheSameBits) {
  for (const double heading_rad : {0.0, -0.0, 0.3, -2.0, 3.1412, kPi}) {
    const Pose from{{0.7, -1.3}, heading_rad};
    for (const Twist twist :
         {Twist{0.3, 0}, {-0.3, 0}, {0, 0}, {0, 0.2}, {0.3, 1e-6}, {0.3, 0.2}}) {
      const Pose expected = AdvanceArc(from, twist, 0.05);
      const Pose known = AdvanceArc(from, Forward(from), twist, 0.05);
      EXPECT_EQ(known.position_world, expected.position_world);
      EXPECT_EQ(known.heading_rad, expected.heading_rad);
      EXPECT_EQ(std::signbit(known.heading_rad), std::signbit(expected.heading_rad));
    }
  }
}

}  // namespace
}  // namespace giveway

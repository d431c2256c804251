#include "services/types/pose.h"

#include <gtest/gtest.h>

#include "services/types/math.h"

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

}  // namespace
}  // namespace giveway

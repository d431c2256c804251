#include "sim_world/dynamics/drive.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/random.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

const RobotModel kP3dx = PioneerP3dx();
const double kSpeedUp = kP3dx.acceleration_m_s2 / kP3dx.drive.wheel_radius_m * kDt_s;
const double kSlowDown = kP3dx.deceleration_m_s2 / kP3dx.drive.wheel_radius_m * kDt_s;

TEST(Drive, AWheelSpeedsUpByTheRimsAcceleration) {
  const WheelSpeeds next = MoveWheels(kP3dx, {}, {5, -5}, kDt_s);
  EXPECT_DOUBLE_EQ(next.left_rad_s, kSpeedUp);
  EXPECT_DOUBLE_EQ(next.right_rad_s, -kSpeedUp);
}

TEST(Drive, AWheelSlowsDownByTheRimsDeceleration) {
  const WheelSpeeds next = MoveWheels(kP3dx, {2, -2}, {0, -1}, kDt_s);
  EXPECT_DOUBLE_EQ(next.left_rad_s, 2 - kSlowDown);
  EXPECT_DOUBLE_EQ(next.right_rad_s, -2 + kSlowDown);
}

TEST(Drive, AWheelReachesItsTargetExactlyAndStaysThere) {
  const WheelSpeeds target = {0.1, 0.05};
  EXPECT_EQ(MoveWheels(kP3dx, {}, target, kDt_s), target);
  EXPECT_EQ(MoveWheels(kP3dx, target, target, kDt_s), target);
}

// Half the tick to brake to standstill, the other half to speed up backwards.
TEST(Drive, AReversingWheelBrakesFirstAndSpeedsUpInTheTimeLeft) {
  const WheelSpeeds next = MoveWheels(kP3dx, {kSlowDown / 2, 0}, {-5, 0}, kDt_s);
  EXPECT_NEAR(next.left_rad_s, -kSpeedUp / 2, 1e-12);
}

TEST(Drive, ACommandBeyondTheCapsEndsOnTheCaps) {
  WheelSpeeds fast;
  WheelSpeeds spin;
  for (int i = 0; i < 400; ++i) {
    fast = MoveWheels(kP3dx, fast, {1e300, 1e300}, kDt_s);
    spin = MoveWheels(kP3dx, spin, {-1e300, 1e300}, kDt_s);
  }
  EXPECT_NEAR(TwistFromWheels(kP3dx.drive, fast).forward_m_s, kP3dx.max_speed_m_s, 1e-12);
  EXPECT_NEAR(TwistFromWheels(kP3dx.drive, spin).turn_rad_s, kP3dx.max_turn_rad_s, 1e-12);
}

// The curve asked for exceeds both caps: forward speed and turn rate are capped separately.
TEST(Drive, ACurveBeyondBothCapsSettlesOnBoth) {
  WheelSpeeds wheels;
  for (int i = 0; i < 400; ++i) wheels = MoveWheels(kP3dx, wheels, {20, 5}, kDt_s);
  const Twist twist = TwistFromWheels(kP3dx.drive, wheels);
  EXPECT_NEAR(twist.forward_m_s, kP3dx.max_speed_m_s, 1e-12);
  EXPECT_NEAR(twist.turn_rad_s, -kP3dx.max_turn_rad_s, 1e-12);
}

TEST(Drive, NoCommandEverBreaksTheCapsOrTheAcceleration) {
  Random random(11);
  WheelSpeeds wheels;
  for (int i = 0; i < 100'000; ++i) {
    const WheelSpeeds target = {random.Uniform(-15, 15), random.Uniform(-15, 15)};
    const WheelSpeeds next = MoveWheels(kP3dx, wheels, target, kDt_s);
    const Twist twist = TwistFromWheels(kP3dx.drive, next);
    ASSERT_LE(std::abs(twist.forward_m_s), kP3dx.max_speed_m_s + 1e-12);
    ASSERT_LE(std::abs(twist.turn_rad_s), kP3dx.max_turn_rad_s + 1e-12);
    const double change = std::abs(next.left_rad_s - wheels.left_rad_s);
    const bool reversed = next.left_rad_s * wheels.left_rad_s < 0;
    const bool grew = !reversed && std::abs(next.left_rad_s) > std::abs(wheels.left_rad_s);
    ASSERT_LE(change, (grew ? kSpeedUp : kSlowDown) + 1e-9) << i;
    wheels = next;
  }
}

// Wheels that speed up faster than they slow down could overshoot the turn cap in between.
TEST(Drive, TheCapsWinOverTheAcceleration) {
  RobotModel eager = kP3dx;
  eager.acceleration_m_s2 = 3;
  Random random(12);
  WheelSpeeds wheels;
  for (int i = 0; i < 100'000; ++i) {
    wheels = MoveWheels(eager, wheels, {random.Uniform(-15, 15), random.Uniform(-15, 15)}, kDt_s);
    const Twist twist = TwistFromWheels(eager.drive, wheels);
    ASSERT_LE(std::abs(twist.forward_m_s), eager.max_speed_m_s + 1e-12);
    ASSERT_LE(std::abs(twist.turn_rad_s), eager.max_turn_rad_s + 1e-12);
  }
}

}  // namespace
}  // namespace giveway::sim

#include "services/types/robot_model.h"

#include <gtest/gtest.h>

#include "services/types/math/math.h"

namespace giveway {
namespace {

// An old simulator shipped this ring ten times too small: the numbers are pinned.
TEST(Profile, TheSonarRingIsArias) {
  const RobotModel p3dx = PioneerP3dx();
  EXPECT_EQ(p3dx.sonar[0].position_body, (Vec2{0.069, 0.136}));
  EXPECT_NEAR(p3dx.sonar[0].bearing_rad, kPi / 2, 1e-12);
  EXPECT_EQ(p3dx.sonar[3].position_body, (Vec2{0.166, 0.027}));
  EXPECT_NEAR(Degrees(p3dx.sonar[4].bearing_rad), -10, 1e-12);
  EXPECT_EQ(p3dx.sonar[11].position_body, (Vec2{-0.255, -0.027}));
}

TEST(Profile, TheRingIsMirroredLeftToRight) {
  const RobotModel p3dx = PioneerP3dx();
  for (std::size_t i = 0; i < 4; ++i) {
    for (const auto& [left, right] : {std::pair{i, 7 - i}, std::pair{15 - i, 8 + i}}) {
      EXPECT_EQ(p3dx.sonar[left].position_body.x, p3dx.sonar[right].position_body.x);
      EXPECT_EQ(p3dx.sonar[left].position_body.y, -p3dx.sonar[right].position_body.y);
      EXPECT_EQ(p3dx.sonar[left].bearing_rad, -p3dx.sonar[right].bearing_rad);
    }
  }
}

TEST(Profile, TheRearEightAreFittedAndSwitchedOff) {
  const RobotModel p3dx = PioneerP3dx();
  for (std::size_t i = 0; i < kSensorCount; ++i) EXPECT_EQ(p3dx.sonar[i].enabled, i < 8) << i;
}

}  // namespace
}  // namespace giveway

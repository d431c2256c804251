#include "services/types/math/math.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/random.h"

namespace giveway {
namespace {

constexpr double kTolerance = 1e-12;

TEST(Math, SinAndCosStayWithinTheirErrorOverManyTurns) {
  Random random(1);
  for (int i = 0; i < 200'000; ++i) {
    const double x = random.Uniform(-1e5, 1e5);
    ASSERT_NEAR(Sin(x), std::sin(x), kTolerance) << x;
    ASSERT_NEAR(Cos(x), std::cos(x), kTolerance) << x;
  }
}

TEST(Math, SinCosGivesTheBitsOfSinAndCos) {
  Random random(3);
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.Uniform(-20, 20);
    const SineCosine both = SinCos(x);
    ASSERT_EQ(both.sine, Sin(x)) << x;
    ASSERT_EQ(both.cosine, Cos(x)) << x;
  }
}

TEST(Math, SinAndCosAreRightAtTheQuarterTurns) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const double x = quarter * kPi / 2;
    EXPECT_NEAR(Sin(x), std::sin(x), kTolerance) << quarter;
    EXPECT_NEAR(Cos(x), std::cos(x), kTolerance) << quarter;
  }
}

TEST(Math, Atan2MatchesInEveryOctantAndOnTheAxes) {
  Random random(2);
  for (int i = 0; i < 200'000; ++i) {
    const double x = random.Uniform(-10, 10);
    const double y = random.Uniform(-10, 10);
    ASSERT_NEAR(Atan2(y, x), std::atan2(y, x), kTolerance) << y << ' ' << x;
  }
  EXPECT_EQ(Atan2(0, 0), 0);
  EXPECT_NEAR(Atan2(0, -1), kPi, kTolerance);
  EXPECT_NEAR(Atan2(-1, 0), -kPi / 2, kTolerance);
}

TEST(Math, LogAndExpMatchOverTheirRange) {
  Random random(3);
  for (int i = 0; i < 200'000; ++i) {
    const double x = random.Uniform(-600, 600);
    ASSERT_NEAR(Exp(x) / std::exp(x), 1.0, kTolerance) << x;
    ASSERT_NEAR(Log(std::exp(x)), std::log(std::exp(x)), kTolerance) << x;
  }
  EXPECT_NEAR(Log(5e-324), std::log(5e-324), kTolerance);
}

TEST(Math, WhatIsNoAngleHasNoSine) {
  for (const double x : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, -1e19}) {
    EXPECT_TRUE(std::isnan(Sin(x))) << x;
    EXPECT_TRUE(std::isnan(Cos(x))) << x;
    EXPECT_TRUE(std::isnan(SinCos(x).sine)) << x;
    EXPECT_TRUE(std::isnan(WrapAngle(x))) << x;
    if (std::isnan(x)) {
      EXPECT_TRUE(std::isnan(Exp(x)));
    }
  }
}

TEST(Math, WrapAngleLandsInTheHalfOpenTurn) {
  EXPECT_NEAR(WrapAngle(3 * kPi), kPi, kTolerance);
  EXPECT_NEAR(WrapAngle(-kPi), kPi, kTolerance);
  EXPECT_NEAR(WrapAngle(-3.5 * kPi), kPi / 2, kTolerance);
  EXPECT_EQ(WrapAngle(0.25), 0.25);
}

}  // namespace
}  // namespace giveway

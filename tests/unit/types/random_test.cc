#include "services/types/math/random.h"

#include <gtest/gtest.h>

namespace giveway {
namespace {

TEST(Random, TheSameSeedGivesTheSameNumbersForEver) {
  Random random(42);
  EXPECT_EQ(random.Next(), 0xbdd732262feb6e95ULL);  // SplitMix64's published sequence for seed 42
  EXPECT_EQ(random.Next(), 0x28efe333b266f103ULL);
}

TEST(Random, StreamsOfOneSeedDiffer) {
  Random first(7, 1);
  Random second(7, 2);
  EXPECT_NE(first.Next(), second.Next());
}

TEST(Random, UniformStaysInItsHalfOpenRangeAndFillsIt) {
  Random random(3);
  double low = 1, high = -1, sum = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.Uniform(-1, 1);
    ASSERT_GE(x, -1);
    ASSERT_LT(x, 1);
    low = std::min(low, x);
    high = std::max(high, x);
    sum += x;
  }
  EXPECT_LT(low, -0.999);
  EXPECT_GT(high, 0.999);
  EXPECT_NEAR(sum / 100'000, 0, 0.01);
}

TEST(Random, GaussianHasTheAskedForSpread) {
  Random random(4);
  double sum = 0, squares = 0;
  constexpr int kDraws = 200'000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Gaussian(2.0);
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.03);
  EXPECT_NEAR(squares / kDraws, 4.0, 0.05);
}

}  // namespace
}  // namespace giveway

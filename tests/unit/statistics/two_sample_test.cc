#include "services/statistics/two_sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "services/types/math/random.h"

namespace giveway::statistics {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

using Values = std::vector<double>;

// Of the 4 choose 2 = 6 rank assignments only one has the two greatest.
TEST(MannWhitney, FewValuesAreCountedOut) {
  EXPECT_NEAR(MannWhitneyGreater(Values{1, 2}, Values{3, 4}), 1.0 / 6, 1e-12);
  EXPECT_NEAR(MannWhitneyGreater(Values{3, 4}, Values{1, 2}), 1, 1e-12);
  EXPECT_NEAR(MannWhitneyGreater(Values{1, 2, 3, 4, 5}, Values{6, 7, 8, 9, 10}), 1.0 / 252, 1e-12);
  EXPECT_EQ(MannWhitneyGreater(Values{}, Values{1}), 1);
}

TEST(MannWhitney, ValuesAllAlikeSayNothing) {
  EXPECT_NEAR(MannWhitneyGreater(Values(10, 5.0), Values(10, 5.0)), 1, 1e-12);
  EXPECT_EQ(MannWhitneyGreater(Values(100, 5.0), Values(100, 5.0)), 1);
}

TEST(MannWhitney, ManyValuesAgreeWithFew) {
  Random random(5);
  Values before, after;
  for (int i = 0; i < 20; ++i) {
    before.push_back(random.Uniform(0, 1));
    after.push_back(random.Uniform(0.2, 1.2));
  }
  const double exact = MannWhitneyGreater(before, after);
  before.push_back(0.6);  // one more, and it is no longer counted out
  EXPECT_NEAR(MannWhitneyGreater(before, after), exact, 0.01);
}

Histogram Normal(std::uint64_t seed, int count, double mean_ms, double sigma_ms) {
  Random random(seed);
  Histogram histogram;
  for (int i = 0; i < count; ++i) {
    histogram.Add(static_cast<std::int64_t>((mean_ms + random.Gaussian(sigma_ms)) * 1e6));
  }
  return histogram;
}

TEST(MannWhitneyOfHistograms, SeesAShiftAndOnlyItsDirection) {
  const Histogram before = Normal(1, 2000, 50, 10);
  const Histogram after = Normal(2, 2000, 53, 10);
  EXPECT_LT(MannWhitneyGreater(before, 1e9, after, 1e9), 1e-9);
  EXPECT_GT(MannWhitneyGreater(after, 1e9, before, 1e9), 0.999);
}

// A hundred times the values from the same few seconds are no more evidence.
TEST(MannWhitneyOfHistograms, WeighsNoMoreThanIsIndependent) {
  const Histogram before = Normal(1, 20'000, 50, 10);
  const Histogram after = Normal(2, 20'000, 50.6, 10);
  EXPECT_LT(MannWhitneyGreater(before, 1e9, after, 1e9), 1e-6);
  EXPECT_GT(MannWhitneyGreater(before, 200, after, 200), 0.1);
}

TEST(TailOfHistograms, SeesWhatTheMedianDoesNot) {
  const Histogram before = Normal(1, 5000, 50, 5);
  Histogram after = Normal(2, 4900, 50, 5);
  after.Merge(Normal(3, 100, 150, 5));
  EXPECT_LT(TailGreater(before, 1e9, after, 1e9), 1e-9);
  EXPECT_GT(TailGreater(after, 1e9, before, 1e9), 0.999);
  EXPECT_GT(MannWhitneyGreater(before, 1e9, after, 1e9), 0.001);
}

// Fisher's lady tasting tea: all 4 of 4 and none of 4 by chance 1 of 70; 3 and 1: 17 of 70.
TEST(Shares, AreFishersExactTest) {
  EXPECT_NEAR(ShareGreater(0, 4, 4, 4), 1.0 / 70, 1e-12);
  EXPECT_NEAR(ShareGreater(1, 4, 3, 4), 17.0 / 70, 1e-12);
  EXPECT_NEAR(ShareGreater(0, 4, 0, 4), 1, 1e-12);
  EXPECT_EQ(ShareGreater(0, 0, 1, 4), 1);
}

// Of 3 of 4 after 4 of 4 at least 3 must be among them.
TEST(Shares, WhatCannotBeOtherwiseSaysNothing) {
  EXPECT_EQ(ShareGreater(4, 4, 3, 4), 1);
  EXPECT_NEAR(ShareGreater(3, 4, 4, 4), 0.5, 1e-12);
}

// A file may claim anything.
TEST(Shares, ImpossibleCountsSayNothing) {
  constexpr std::uint64_t kHuge = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(ShareGreater(5, 4, 4, 4), 1);
  EXPECT_EQ(ShareGreater(0, 4, 5, 4), 1);
  EXPECT_EQ(ShareGreater(0, kHuge, 4, 4), 1);
  EXPECT_EQ(ShareGreater(0, 4, kHuge, kHuge), 1);
  EXPECT_EQ(ShareGreater(kHuge, 4, 2, 4), 1);
}

// Summed by hand, in logarithms of factorials.
TEST(Shares, OfAMillionAreStillCountedOut) {
  EXPECT_NEAR(ShareGreater(10'000, 1'000'000, 10'300, 1'000'000), 0.01745806, 1e-7);
}

// 5 events in equal time, all in the second half: 1 of 32.
TEST(Rates, AreTheConditionalBinomialTest) {
  EXPECT_NEAR(RateGreater(0, 1, 5, 1), 1.0 / 32, 1e-12);
  EXPECT_NEAR(RateGreater(0, 3, 2, 1), 1.0 / 16, 1e-12);
  EXPECT_NEAR(RateGreater(5, 1, 0, 1), 1, 1e-12);
  EXPECT_EQ(RateGreater(1, 0, 1, 0), 1);
  EXPECT_NEAR(RateGreater(1'000'000, 1, 1'003'000, 1), 0.01704418, 1e-7);
}

TEST(Holm, TakesAllTestsTogether) {
  EXPECT_THAT(HolmAdjusted(Values{0.01, 0.04, 0.03, 0.5}),
              ElementsAre(DoubleNear(0.04, 1e-12), DoubleNear(0.09, 1e-12), DoubleNear(0.09, 1e-12),
                          DoubleNear(0.5, 1e-12)));
  EXPECT_TRUE(HolmAdjusted({}).empty());
}

}  // namespace
}  // namespace giveway::statistics

#include "services/statistics/two_sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
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

// Of the 2^5 choices of signs one has all ranks positive.
TEST(Series, OfFewPlacesAreCountedOut) {
  EXPECT_NEAR(SeriesGreater(Values{1, 2, 3, 4, 5}, Values{4, 3, 8, 6, 9}), 1.0 / 32, 1e-12);
  EXPECT_GT(SeriesGreater(Values{4, 3, 8, 6, 9}, Values{1, 2, 3, 4, 5}), 0.99);
  EXPECT_NEAR(SeriesGreater(Values{1, 1, 1, 1}, Values{2, 2, 2, 2}), 1.0 / 16, 1e-12);
  EXPECT_EQ(SeriesGreater(Values{}, Values{1}), 1);
  EXPECT_EQ(SeriesGreater(Values{1, 2}, Values{1, 2}), 1);
}

// What differs from place to place alike in both is no difference.
TEST(Series, AreComparedPlaceByPlace) {
  Random random(5);
  Values before, after;
  for (int i = 0; i < 20; ++i) {
    before.push_back(100.0 * i + random.Uniform(0, 1));
    after.push_back(100.0 * i + random.Uniform(1, 2));
  }
  EXPECT_LT(SeriesGreater(before, after), 1e-5);
  EXPECT_GT(MannWhitneyGreater(before, after), 0.3);
}

// Twenty values, each like the one before it to the share `alike`.
Values Wandering(Random* random, double alike) {
  Values values{random->Gaussian(1)};
  while (values.size() < 20) {
    values.push_back(alike * values.back() + random->Gaussian(std::sqrt(1 - alike * alike)));
  }
  return values;
}

int FoundOf2000(double alike, double below) {
  Random random(7);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Values before = Wandering(&random, alike);
    found += SeriesGreater(before, Wandering(&random, alike)) < below ? 1 : 0;
  }
  return found;
}

TEST(Series, NeighboursThatAreAlikeAreNoEvidence) {
  EXPECT_LE(FoundOf2000(0, 0.01), 20);
  EXPECT_LE(FoundOf2000(0.5, 0.01), 60);
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

TEST(Holm, TakesAllTestsTogether) {
  EXPECT_THAT(HolmAdjusted(Values{0.01, 0.04, 0.03, 0.5}),
              ElementsAre(DoubleNear(0.04, 1e-12), DoubleNear(0.09, 1e-12), DoubleNear(0.09, 1e-12),
                          DoubleNear(0.5, 1e-12)));
  EXPECT_TRUE(HolmAdjusted({}).empty());
}

}  // namespace
}  // namespace giveway::statistics

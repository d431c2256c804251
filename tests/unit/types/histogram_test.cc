#include "services/types/figures/histogram.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace giveway {
namespace {

constexpr std::int64_t kMicrosecond = 1000;

// All orders of magnitude alike, from 1 us to 1 h: what matters is how many digits are left.
rc::Gen<std::vector<std::int64_t>> Durations() {
  const auto one = rc::gen::map(
      rc::gen::pair(rc::gen::inRange(0, 32), rc::gen::inRange<std::int64_t>(0, 1'000'000'000)),
      [](const std::pair<int, std::int64_t>& drawn) {
        const std::int64_t low = kMicrosecond << drawn.first;
        return std::min(Histogram::kHighest, low + drawn.second % low);
      });
  return rc::gen::nonEmpty(rc::gen::container<std::vector<std::int64_t>>(one));
}

Histogram Of(const std::vector<std::int64_t>& values) {
  Histogram histogram;
  for (const std::int64_t value : values) histogram.Add(value);
  return histogram;
}

RC_GTEST_PROP(HistogramProperty, QuantilesAreOrderStatisticsToHalfAThousandth, ()) {
  std::vector<std::int64_t> values = *Durations();
  const double p = *rc::gen::inRange(0, 1001) / 1000.0;
  const Histogram histogram = Of(values);
  std::ranges::sort(values);
  const double asked = std::ceil(p * static_cast<double>(values.size()));
  const auto rank = static_cast<std::size_t>(std::max(asked, 1.0));
  const double exact = static_cast<double>(values[rank - 1]);
  RC_ASSERT(std::abs(static_cast<double>(histogram.Quantile(p)) - exact) <= exact * 0.0005);
}

RC_GTEST_PROP(HistogramProperty, MergingIsAssociativeCommutativeAndLosesNothing, ()) {
  const std::vector<std::int64_t> a = *Durations();
  const std::vector<std::int64_t> b = *Durations();
  const std::vector<std::int64_t> c = *Durations();
  Histogram left = Of(a);
  left.Merge(Of(b));
  left.Merge(Of(c));
  Histogram right = Of(c);
  right.Merge(Of(b));
  Histogram all = Of(a);
  all.Merge(right);
  std::vector<std::int64_t> values = a;
  values.insert(values.end(), b.begin(), b.end());
  values.insert(values.end(), c.begin(), c.end());
  RC_ASSERT(left == all);
  RC_ASSERT(left == Of(values));
}

RC_GTEST_PROP(HistogramProperty, ComesBackFromItsBuckets, ()) {
  const Histogram histogram = Of(*Durations());
  const auto back = Histogram::From(histogram.Buckets(), histogram.Min(), histogram.Max(), 0);
  RC_ASSERT(back.has_value());
  RC_ASSERT(*back == histogram);
}

TEST(Histogram, NothingAddedIsNothingSaid) {
  const Histogram histogram;
  EXPECT_EQ(histogram.Count(), 0U);
  EXPECT_EQ(histogram.Quantile(0.5), 0);
  EXPECT_EQ(histogram.Max(), 0);
  EXPECT_EQ(histogram.Mean(), 0);
  EXPECT_TRUE(histogram.Buckets().empty());
}

TEST(Histogram, SmallValuesAreExact) {
  Histogram histogram;
  for (std::int64_t value = 0; value < 2048; ++value) histogram.Add(value);
  EXPECT_EQ(histogram.Quantile(0), 0);
  EXPECT_EQ(histogram.Quantile(0.5), 1023);
  EXPECT_EQ(histogram.Quantile(1), 2047);
  EXPECT_EQ(histogram.Mean(), 1023.5);
}

TEST(Histogram, WhatIsBeyondTheRangeIsClampedAndCounted) {
  Histogram histogram;
  histogram.Add(-5);
  histogram.Add(Histogram::kHighest);
  EXPECT_EQ(histogram.Clamped(), 0U);
  histogram.Add(Histogram::kHighest + 1, 2);
  histogram.Add(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.Clamped(), 3U);
  EXPECT_EQ(histogram.Min(), 0);
  EXPECT_EQ(histogram.Max(), Histogram::kHighest);
  EXPECT_EQ(histogram.Count(), 5U);
}

TEST(Histogram, MetresAreMicrometresAndNanIsNone) {
  Histogram histogram;
  histogram.AddMetres(0.25);
  histogram.AddMetres(std::nan(""));
  histogram.AddMetres(std::numeric_limits<double>::infinity());
  EXPECT_EQ(histogram.Count(), 1U);
  EXPECT_EQ(histogram.Max(), 250'000);
  histogram.AddMetres(1e300);
  EXPECT_EQ(histogram.Clamped(), 1U);
}

TEST(Histogram, BucketsThatAreNoneOfItsOwnAreRefused) {
  const std::vector<HistogramBucket> good{{1000, 1}, {4096, 2}};
  EXPECT_TRUE(Histogram::From(good, 1000, 4097, 0));
  EXPECT_FALSE(Histogram::From(std::vector<HistogramBucket>{{4097, 1}}, 4097, 4097, 0));  // inside
  EXPECT_FALSE(Histogram::From(std::vector<HistogramBucket>{{9, 1}, {8, 1}}, 8, 9, 0));
  EXPECT_FALSE(Histogram::From(std::vector<HistogramBucket>{{9, 0}}, 9, 9, 0));
  EXPECT_FALSE(Histogram::From(good, 1000, 4100, 0));  // max in no bucket that holds something
  EXPECT_FALSE(Histogram::From(good, 999, 4097, 0));
  EXPECT_FALSE(Histogram::From(good, 1000, 4097, 4));  // more clamped than there are
}

}  // namespace
}  // namespace giveway

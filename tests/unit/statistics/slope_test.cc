// Which growth is called a leak, and how often noise is.
#include "services/statistics/slope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "services/types/math/random.h"

namespace giveway::statistics {
namespace {

constexpr double kPage = 4096;
constexpr double kMiB = 1048576;

std::vector<Sample> EachSecond(std::size_t count, const std::function<double(double)>& value) {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = static_cast<double>(i);
    samples.push_back({time_s, value(time_s)});
  }
  return samples;
}

// As /proc reports it: in whole pages.
double Pages(double bytes) { return std::floor(bytes / kPage) * kPage; }

// As an allocator does: grows for half a minute, then gives back.
double Sawtooth(double time_s) { return std::fmod(time_s, 31) * 20'000; }

TEST(TheilSenSlope, ALineIsKnownExactly) {
  const auto slope = TheilSen(EachSecond(50, [](double t) { return 7 + 2 * t; }));
  ASSERT_TRUE(slope);
  EXPECT_DOUBLE_EQ(slope->per_hour, 7200);
  EXPECT_DOUBLE_EQ(slope->low_per_hour, 7200);
  EXPECT_DOUBLE_EQ(slope->high_per_hour, 7200);
  EXPECT_EQ(slope->samples, 50U);
  EXPECT_EQ(slope->spans_s, 49);
}

// Sen 1968 has no series that long; this one is by hand: of 20 values 0..19 with the last two
// exchanged S = 188 and the variance 20*19*45/18 = 950, so C = 60.4 and the interval reaches from
// the 64th of 190 slopes to the 126th: all of them 1 but those that touch the exchanged pair.
TEST(TheilSenSlope, TheIntervalIsKendalls) {
  const auto slope = TheilSen(EachSecond(20, [](double t) {
    return t == 18 ? 19 : t == 19 ? 18 : t;
  }));
  ASSERT_TRUE(slope);
  EXPECT_DOUBLE_EQ(slope->low_per_hour, 3600);
  EXPECT_DOUBLE_EQ(slope->high_per_hour, 3600);
}

TEST(TheilSenSlope, TooFewSamplesOrOneMomentSayNothing) {
  EXPECT_FALSE(TheilSen(EachSecond(kLeastSamples - 1, [](double t) { return t; })));
  EXPECT_FALSE(TheilSen(std::vector<Sample>(30, {1, 2})));
  EXPECT_TRUE(TheilSen(EachSecond(kLeastSamples, [](double t) { return t; })));
}

TEST(TheilSenSlope, AQuarterOfWildSamplesDoesNotMoveIt) {
  Random random(1);
  const auto slope = TheilSen(EachSecond(400, [&random](double t) {
    return random.Uniform(0, 1) < 0.2 ? random.Uniform(0, 1e9) : 100 * t;
  }));
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->per_hour, 360'000, 20'000);
}

TEST(TheilSenSlope, ADayOfSamplesIsTakenTogether) {
  const auto slope = TheilSen(EachSecond(86'400, [](double t) { return 5 * t; }));
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->per_hour, 18'000, 1e-6);
  EXPECT_EQ(slope->samples, 86'400U);
}

TEST(BlockMediansOfSamples, KeepOrderAndEnds) {
  const auto medians = BlockMedians(EachSecond(10, [](double t) { return -t; }), 3);
  ASSERT_EQ(medians.size(), 3U);
  EXPECT_EQ(medians[0], (Sample{1, -1}));
  EXPECT_EQ(medians[1], (Sample{4, -4}));
  EXPECT_EQ(medians[2], (Sample{7.5, -7.5}));
}

// 1 kB/s is 3.6 MB an hour; five minutes of it, under a sawtooth of 0.6 MB and noise of 50 kB.
TEST(Leak, OneKilobyteASecondIsFoundInFiveMinutes) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const auto slope = TheilSen(EachSecond(300, [&random](double t) {
      return Pages(20 * kMiB + 1000 * t + Sawtooth(t) + random.Gaussian(50'000));
    }));
    ASSERT_TRUE(slope);
    EXPECT_TRUE(IsLeak(*slope, kLeastLeakBytes)) << seed << ' ' << slope->low_per_hour;
    EXPECT_NEAR(slope->per_hour, 3.6e6, 1.5e6) << seed;
  }
}

TEST(Leak, ASawtoothIsNone) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const double begin = random.Uniform(0, 31);
    const auto slope = TheilSen(EachSecond(300, [&](double t) {
      return Pages(20 * kMiB + Sawtooth(t + begin) + random.Gaussian(20'000));
    }));
    ASSERT_TRUE(slope);
    EXPECT_FALSE(IsLeak(*slope, kLeastLeakBytes)) << seed << ' ' << slope->low_per_hour;
  }
}

// A table that is allocated once, as late as possible.
TEST(Leak, OneStepIsNone) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const double at_s = random.Uniform(30, 270);
    const auto slope = TheilSen(EachSecond(300, [&](double t) {
      return Pages(20 * kMiB + (t > at_s ? kMiB : 0) + random.Gaussian(10'000));
    }));
    ASSERT_TRUE(slope);
    EXPECT_FALSE(IsLeak(*slope, kLeastLeakBytes)) << seed << ' ' << at_s;
  }
}

TEST(Leak, GrowthBelow64KiBAnHourIsNone) {
  const auto slope = TheilSen(EachSecond(3600, [](double t) { return 50 * 1024 * t / 3600; }));
  ASSERT_TRUE(slope);
  EXPECT_GT(slope->low_per_hour, 0);
  EXPECT_FALSE(IsLeak(*slope, kLeastLeakBytes));
}

TEST(Leak, ADescriptorAMinuteIsFoundAndAFlatCountIsNone) {
  const auto lost = TheilSen(EachSecond(300, [](double t) { return 40 + std::floor(t / 60); }));
  ASSERT_TRUE(lost);
  EXPECT_TRUE(IsLeak(*lost, kLeastLeakPieces)) << lost->low_per_hour;
  const auto flat = TheilSen(EachSecond(300, [](double t) { return t == 77 ? 41 : 40; }));
  ASSERT_TRUE(flat);
  EXPECT_FALSE(IsLeak(*flat, kLeastLeakPieces));
}

TEST(Growth, IsInEachPartOrNotThroughout) {
  EXPECT_TRUE(GrowsThroughout(EachSecond(300, [](double t) { return t; })));
  EXPECT_TRUE(GrowsThroughout(EachSecond(300, [](double t) { return std::floor(t / 20); })));
  EXPECT_FALSE(GrowsThroughout(EachSecond(300, [](double t) { return std::min(t, 200.0); })));
  EXPECT_FALSE(GrowsThroughout(EachSecond(300, [](double t) { return t < 150 ? 0.0 : 1.0; })));
  EXPECT_FALSE(GrowsThroughout(EachSecond(19, [](double t) { return t; })));
}

// The heap of vehicle 11 in half an hour of everything, in kB, every 16 s of its third life: it
// fills up in steps, as peers and worlds come back, and between them it rises by next to nothing.
TEST(Growth, OfNextToNothingIsStandingStill) {
  const std::vector<double> heap_kb = {
      6582, 6586, 6622, 6650, 6666, 6666, 6666, 6675, 6675, 6675, 6675, 6675, 6692, 6701, 6751,
      6853, 6856, 6857, 6857, 6857, 6856, 6859, 6860, 6860, 6860, 6861, 6861, 6952, 6960, 6980,
      7003, 7005, 7006, 7022, 7023, 7048, 7048, 7059, 7060, 7060, 7067, 7068, 7076, 7076, 7101,
      7116, 7121, 7121, 7122, 7121, 7121, 7121, 7121, 7122, 7129, 7129, 7130, 7130, 7139, 7267};
  std::vector<Sample> samples;
  for (const double kb : heap_kb)
    samples.push_back({16.0 * static_cast<double>(samples.size()), 1000 * kb});
  EXPECT_GT(TheilSen(samples)->low_per_hour, kLeastLeakBytes);
  EXPECT_FALSE(GrowsThroughout(samples));
  // The same and a leak of 1 kB/s.
  for (Sample& sample : samples) sample.value += 1000 * sample.time_s;
  EXPECT_TRUE(GrowsThroughout(samples));
}

// How often noise alone is called a leak: 2.5 % of independent noise, by the interval; of noise
// correlated over five samples hardly more.
TEST(Leak, NoiseIsSeldomCalledOne) {
  int white = 0;
  int red = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    const auto noise =
        TheilSen(EachSecond(120, [&random](double) { return random.Gaussian(1e6); }));
    if (IsLeak(*noise, 0)) ++white;
    double state = 0;
    const auto wave = TheilSen(EachSecond(120, [&](double) {
      state = 0.8 * state + random.Gaussian(1e6);
      return state;
    }));
    if (IsLeak(*wave, 0)) ++red;
  }
  RecordProperty("white_of_1000", white);
  RecordProperty("red_of_1000", red);
  EXPECT_LE(white, 40);
  EXPECT_LE(red, 50);
}

}  // namespace
}  // namespace giveway::statistics

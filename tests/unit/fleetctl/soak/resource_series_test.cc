#include "services/fleetctl/soak/resource_series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "services/types/math/random.h"

namespace giveway::fleetctl {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr double kWarmUp_s = 10;

ProcessResources Using(double cpu_s, double private_bytes, std::uint32_t descriptors = 30) {
  return {.cpu_s = cpu_s,
          .resident_bytes = 40'000'000,
          .private_bytes = static_cast<std::uint64_t>(private_bytes),
          .threads = 12,
          .descriptors = descriptors};
}

const ResourceSlope* Find(const std::vector<ResourceSlope>& slopes, const std::string& process,
                          std::uint32_t life, ResourceKind kind) {
  const auto row = std::ranges::find_if(slopes, [&](const ResourceSlope& slope) {
    return slope.process == process && slope.life == life && slope.kind == kind;
  });
  return row == slopes.end() ? nullptr : &*row;
}

TEST(ABoundedSeries, HalvesItselfWhenFullAndKeepsTheMeans) {
  BoundedSeries series;
  for (int t = 0; t < 100'000; ++t) series.Add(t, 2.0 * t);
  EXPECT_LT(series.Points().size(), BoundedSeries::kMostPoints);
  EXPECT_GE(series.Points().size(), BoundedSeries::kMostPoints / 2);
  EXPECT_EQ(series.Stride(), 128U);
  for (const statistics::Sample& sample : series.Points()) {
    ASSERT_DOUBLE_EQ(sample.value, 2 * sample.time_s);
  }
  EXPECT_DOUBLE_EQ(series.Points()[0].time_s, 63.5);
  EXPECT_DOUBLE_EQ(series.Points()[1].time_s, 191.5);
}

TEST(ResourcesOverTime, NameWhoLeaksAndNobodyElse) {
  ResourceSeries series(kWarmUp_s);
  for (int t = 0; t < 300; ++t) {
    series.Add("vehicle-1", t, Using(0.1 * t, 2e7 + 1000.0 * t));
    series.Add("vehicle-2", t, Using(0.1 * t, 2e7, 30 + static_cast<std::uint32_t>(t) / 30));
    series.Add("world", t, Using(0.2 * t, 3e7));
  }
  const std::vector<ResourceSlope> slopes = series.Slopes();
  for (const ResourceSlope& row : slopes) {
    const bool leaking = (row.process == "vehicle-1" && row.kind == ResourceKind::kPrivateBytes) ||
                         (row.process == "vehicle-2" && row.kind == ResourceKind::kDescriptors);
    EXPECT_EQ(row.leak, leaking) << row.process << ' ' << ToString(row.kind);
  }
  const ResourceSlope* leak = Find(slopes, "vehicle-1", 0, ResourceKind::kPrivateBytes);
  ASSERT_NE(leak, nullptr);
  EXPECT_NEAR(leak->slope.per_hour, 3.6e6, 1e3);
  EXPECT_EQ(leak->curve.size(), 60U);
  const ResourceSlope* cpu = Find(slopes, "world", 0, ResourceKind::kProcessors);
  ASSERT_NE(cpu, nullptr);
  EXPECT_NEAR(cpu->last, 0.2, 1e-9);
}

// As of one that an allocator serves from pages it already has.
TEST(ResourcesOverTime, AHeapThatGrowsInSteadyPrivateMemoryIsALeak) {
  ResourceSeries series(kWarmUp_s);
  for (std::uint32_t t = 0; t < 300; ++t) {
    series.Add("vehicle-1", t, Using(0, 2e7), 8'000'000 + 1000 * t);
    series.Add("vehicle-2", t, Using(0, 2e7), 8'000'000 + t % 3);
  }
  const std::vector<ResourceSlope> slopes = series.Slopes();
  const ResourceSlope* leak = Find(slopes, "vehicle-1", 0, ResourceKind::kHeapBytes);
  ASSERT_NE(leak, nullptr);
  EXPECT_NEAR(leak->slope.per_hour, 3.6e6, 1e3);
  for (const ResourceSlope& row : slopes) {
    EXPECT_EQ(row.leak, &row == leak) << row.process << ' ' << ToString(row.kind);
    EXPECT_EQ(row.curve.empty(),
              row.kind != ResourceKind::kHeapBytes && row.kind != ResourceKind::kPrivateBytes);
  }
}

TEST(ResourcesOverTime, AHeapThatIsNotKnownHasNoSlope) {
  ResourceSeries series(0);
  for (int t = 0; t < 100; ++t) series.Add("world", t, Using(0, 2e7));
  EXPECT_EQ(Find(series.Slopes(), "world", 0, ResourceKind::kHeapBytes), nullptr);
}

TEST(ResourcesOverTime, WarmingUpIsNoGrowth) {
  ResourceSeries series(60);
  for (int t = 0; t < 100; ++t) series.Add("world", t, Using(t, 1e6 * std::min(t, 60)));
  for (const ResourceSlope& row : series.Slopes()) {
    EXPECT_EQ(row.slope.per_hour, 0) << ToString(row.kind);
  }
}

TEST(ResourcesOverTime, ARestartBeginsAnotherLifeWithItsOwnWarmUp) {
  ResourceSeries series(kWarmUp_s);
  for (int t = 0; t < 100; ++t) series.Add("vehicle-1", t, Using(t, 2e7));
  series.EndLife("vehicle-1");
  for (int t = 100; t < 200; ++t) series.Add("vehicle-1", t, Using(t - 100, 5e7));
  const std::vector<ResourceSlope> slopes = series.Slopes();
  for (const std::uint32_t life : {0U, 1U}) {
    const ResourceSlope* row = Find(slopes, "vehicle-1", life, ResourceKind::kPrivateBytes);
    ASSERT_NE(row, nullptr);
    EXPECT_FALSE(row->leak);
    EXPECT_EQ(row->slope.per_hour, 0);
    EXPECT_EQ(row->slope.samples, 90U);
  }
  EXPECT_EQ(series.LivesTooShort(), 2U) << "one that ended, and one that lives";
}

TEST(ResourcesOverTime, AShortLifeIsCountedAndNotJudged) {
  ResourceSeries series(kWarmUp_s);
  for (int t = 0; t < 20; ++t) series.Add("vehicle-1", t, Using(t, 1e6 * t));
  series.EndLife("vehicle-1");
  series.EndLife("unknown");
  EXPECT_THAT(series.Slopes(), IsEmpty());
  EXPECT_EQ(series.LivesTooShort(), 1U);
}

TEST(ResourcesOverTime, OfAThousandLivesTheLeaksAreKept) {
  ResourceSeries series(0);
  for (int life = 0; life < 1500; ++life) {
    const double growth = life == 3 ? 1e4 : 0;
    for (int t = 0; t < 130; ++t)
      series.Add("vehicle-1", 130.0 * life + t, Using(t, 2e7 + growth * t));
    series.EndLife("vehicle-1");
  }
  const std::vector<ResourceSlope> slopes = series.Slopes();
  EXPECT_THAT(slopes, SizeIs(3000));
  const ResourceSlope* leak = Find(slopes, "vehicle-1", 3, ResourceKind::kPrivateBytes);
  ASSERT_NE(leak, nullptr);
  EXPECT_TRUE(leak->leak);
}

// As pools and histories grow: half of what is missing every forty seconds, in pages.
TEST(ResourcesOverTime, WhatFillsUpIsNoLeak) {
  ResourceSeries series(kWarmUp_s);
  for (int t = 0; t < 300; ++t) {
    const double pages = std::floor(100 * (1 - std::exp2(-t / 40.0)));
    series.Add("vehicle-1", t, Using(t, 2e7 + 4096 * pages));
  }
  const std::vector<ResourceSlope> slopes = series.Slopes();
  const ResourceSlope* filling = Find(slopes, "vehicle-1", 0, ResourceKind::kPrivateBytes);
  ASSERT_NE(filling, nullptr);
  EXPECT_GT(filling->slope.low_per_hour, statistics::kLeastLeakBytes);
  EXPECT_FALSE(filling->leak);
}

TEST(ResourcesOverTime, OfALifeOfLessThanTwoMinutesNoGrowthIsALeak) {
  ResourceSeries series(0);
  for (int t = 0; t < 119; ++t) series.Add("vehicle-1", t, Using(t, 2e7 + 1e4 * t));
  for (const ResourceSlope& row : series.Slopes()) EXPECT_FALSE(row.leak);
  EXPECT_EQ(series.LivesTooShort(), 1U);
  for (int t = 119; t < 125; ++t) series.Add("vehicle-1", t, Using(t, 2e7));
  EXPECT_EQ(series.LivesTooShort(), 0U);
}

// A hundred flat series with noise: one in forty seems to grow, and none is called a leak.
TEST(ResourcesOverTime, ChanceIsNoLeakHoweverManyAreWatched) {
  int seeming = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    ResourceSeries series(0);
    for (int t = 0; t < 120; ++t) {
      for (int vehicle = 0; vehicle < 50; ++vehicle) {
        series.Add("vehicle-" + std::to_string(vehicle), t, Using(0, 2e7 + random.Gaussian(1e6)));
      }
    }
    for (const ResourceSlope& row : series.Slopes()) {
      EXPECT_FALSE(row.leak) << seed << ' ' << row.process;
      if (statistics::IsLeak(row.slope, statistics::kLeastLeakBytes)) ++seeming;
    }
  }
  EXPECT_GT(seeming, 3);
}

TEST(ResourcesOverTime, SharedMemoryBelongsToTheFleet) {
  ResourceSeries series(kWarmUp_s);
  for (std::uint32_t t = 0; t < 200; ++t)
    series.AddSharedMemory(t, 1'000'000 + 500'000ULL * (t / 10));
  const std::vector<ResourceSlope> slopes = series.Slopes();
  ASSERT_THAT(slopes, SizeIs(1));
  EXPECT_EQ(slopes[0].process, "fleet");
  EXPECT_TRUE(slopes[0].leak);
}

// The first process has used two minutes before the first sample; the second dies and is started
// again, and has used half a second when it is sampled first.
TEST(ResourcesOverTime, TheSupervisorIsComparedWithAllProcessesSinceTheFirstSample) {
  ResourceSeries series(kWarmUp_s);
  EXPECT_FALSE(series.SupervisorShare());
  for (int t = 0; t <= 20; ++t) {
    series.Add("vehicle-1", t, Using(120 + 0.5 * t, 2e7));
    if (t == 10) series.EndLife("vehicle-2");
    series.Add("vehicle-2", t, Using(0.5 * (t < 10 ? t + 1 : t - 9), 2e7));
    series.AddSupervisor(30 + 0.1 * t);
  }
  EXPECT_DOUBLE_EQ(series.SupervisorShare().value_or(0), 2 / (10 + 4.5 + 5.5));
}

TEST(SharedMemoryOfMaps, CountsEachSegmentOnceAndOnlyThose) {
  const std::string first =
      "7f0000000000-7f0000080000 rw-s 00000000 00:1a 17 /dev/shm/fastrtps_port7411\n"
      "7f0000100000-7f0000101000 rw-s 00000000 00:1a 18 /dev/shm/fastrtps_a (deleted)\n"
      "7f0000200000-7f0000300000 r-xp 00000000 08:01 99 /usr/lib/libfastrtps.so\n";
  const std::string second =
      "7f1000000000-7f1000080000 rw-s 00000000 00:1a 17 /dev/shm/fastrtps_port7411\n"
      "not a line of maps /dev/shm/x\n";
  EXPECT_EQ(SharedMemoryIn({first, second, ""}), 0x81000U);
}

}  // namespace
}  // namespace giveway::fleetctl

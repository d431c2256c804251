// What the difference of two scans says of the transducers.
#include "services/vehicle/estimation/scan_change.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::ClearScan;
using test::SetEcho;

// What a sensor of the eight in front hears.
struct Heard {
  int sensor;
  double range_m;
};
using Scan = std::vector<Heard>;

RangeScan ScanOf(std::uint32_t tick, const Scan& echoes) {
  RangeScan scan = ClearScan(tick);
  for (const Heard& heard : echoes) SetEcho(&scan, heard.sensor, heard.range_m);
  return scan;
}

class ScanChangeOf : public testing::Test {
 protected:
  ScanChange From(const Scan& before, const Scan& after, std::uint32_t ticks = 1) {
    RangeView view;
    view.Take(ScanOf(10, before), SteadyTime{0}, options_.tick_period);
    return ChangeOf(view, ScanOf(10 + ticks, after), options_, ConesOf(options_.profile));
  }
  ScanNews News(const Scan& before, const Scan& after, std::uint32_t ticks = 1) {
    return From(before, after, ticks).news;
  }

  VehicleOptions options_ = test::DefaultOptions();
};

const Scan kEight = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 4}, {5, 3}, {6, 2}, {7, 1}};
const Scan kEightElsewhere = {{0, 2}, {1, 3}, {2, 4}, {3, 1}, {4, 2}, {5, 4}, {6, 1}, {7, 3}};

TEST_F(ScanChangeOf, TheFirstScanIsAsOfUltrasonicsThatWork) {
  const ScanChange change = ChangeOf({}, ScanOf(10, {{3, 2}}), options_, ConesOf(options_.profile));
  EXPECT_EQ(change.news, ScanNews::kOther);
}

TEST_F(ScanChangeOf, AllClearIsOfEverySensor) {
  EXPECT_EQ(News({}, {}), ScanNews::kAllClear);
  EXPECT_EQ(From({}, {}).echoes, 0U);
  EXPECT_EQ(News({{3, 2}}, {}, 7), ScanNews::kAllClear);
}

TEST_F(ScanChangeOf, AllClearOfSomeCountsOnlyWhereTheOthersAreSwitchedOff) {
  RangeView view;
  view.Take(ScanOf(10, {}), SteadyTime{0}, options_.tick_period);
  RangeScan scan = ScanOf(11, {});
  scan.readings[5].kind = Echo::kNoData;
  EXPECT_EQ(ChangeOf(view, scan, options_, ConesOf(options_.profile)).news, ScanNews::kNone);
  options_.profile.sonar[5].enabled = false;
  EXPECT_EQ(ChangeOf(view, scan, options_, ConesOf(options_.profile)).news, ScanNews::kAllClear);
}

TEST_F(ScanChangeOf, AnEchoVanishesFromAmidOtherConesAlone) {
  const ScanChange change = From({{3, 2}, {4, 1.5}}, {});
  EXPECT_EQ(change.echoes, 1U << 3 | 1U << 4);
  EXPECT_EQ(change.was_m[3], 2);
  EXPECT_EQ(change.was_m[4], 1.5);
  EXPECT_EQ(From({{2, 2}, {5, 3}}, {}).echoes, 1U << 2 | 1U << 5);
  EXPECT_EQ(From({{0, 2}, {1, 2}, {6, 2}, {7, 2}}, {}).echoes, 0U) << "next to a gap";
  options_.profile.sonar[2].enabled = false;
  EXPECT_EQ(From({{3, 2}}, {}).echoes, 0U) << "a gap now";
}

TEST_F(ScanChangeOf, AThinBodyNearByIsBetweenCones) { EXPECT_EQ(From({{3, 0.3}}, {}).echoes, 0U); }

TEST_F(ScanChangeOf, AnEchoMayLeaveTheRange) {
  const double max_m = options_.profile.sonar_max_range_m;
  EXPECT_EQ(From({{3, max_m - 0.1}}, {}).echoes, 0U);
  EXPECT_NE(From({{3, max_m - 0.2}}, {}).echoes, 0U);
}

TEST_F(ScanChangeOf, AnEchoMayHaveGoneInTicksThatWereMissed) {
  EXPECT_EQ(From({{3, 2}}, {}, 2).echoes, 0U);
}

TEST_F(ScanChangeOf, TheSameToTheLastBitIsTheSame) {
  EXPECT_EQ(News({{3, 2}, {0, 1}}, {{3, 2}, {0, 1}}), ScanNews::kSame);
  EXPECT_EQ(News({{3, 2}, {0, 1}}, {{3, 2}, {0, 1 + 1e-12}}), ScanNews::kOther);
  EXPECT_EQ(News({{3, 2}, {0, 1}}, {{3, 2}}), ScanNews::kOther);
  EXPECT_EQ(News({{3, 2}}, {{3, 2}}, 2), ScanNews::kSame) << "two ticks later";
  EXPECT_EQ(From({{3, 2}, {0, 1}}, {{3, 2}, {0, 1}}).echoes, 1U << 3 | 1U << 0);
}

TEST_F(ScanChangeOf, OneThatHasNotFiredSaysNothing) {
  RangeView view;
  view.Take(ScanOf(10, {{3, 2}, {0, 1}}), SteadyTime{0}, options_.tick_period);
  RangeScan scan = ScanOf(11, {{3, 2}, {0, 1}});
  scan.readings[0].tick = Tick{10};
  EXPECT_EQ(ChangeOf(view, scan, options_, ConesOf(options_.profile)).news, ScanNews::kSame);
  for (RangeReading& reading : scan.readings) reading.tick = Tick{10};
  EXPECT_EQ(ChangeOf(view, scan, options_, ConesOf(options_.profile)).news, ScanNews::kNone);
}

TEST_F(ScanChangeOf, OneThatMissedAnEchoSaidThatAllIsClear) {
  options_.sonar_noise = 0.01;
  RangeView view;
  const auto take = [&](std::uint32_t tick, const Scan& echoes) {
    view.TakeImperfect(ScanOf(tick, echoes), SteadyTime{0}, options_.tick_period, {});
  };
  take(10, {{3, 2}, {0, 1}});
  take(11, {{0, 1}});
  ASSERT_TRUE(view[3].missed);
  const Cones cones = ConesOf(options_.profile);
  EXPECT_EQ(ChangeOf(view, ScanOf(12, {{0, 1}}), options_, cones).news, ScanNews::kSame);
  EXPECT_EQ(ChangeOf(view, ScanOf(12, {{3, 2}, {0, 1}}), options_, cones).news, ScanNews::kOther);
}

TEST_F(ScanChangeOf, LeapsAreOfMoreThanHalf) {
  EXPECT_EQ(News(kEight, kEightElsewhere), ScanNews::kLeaps);
  EXPECT_EQ(News(kEight, {{0, 4}, {1, 4}, {2, 1}, {3, 1}}), ScanNews::kLeaps) << "four fell silent";
  EXPECT_EQ(News({}, kEight), ScanNews::kLeaps);
  Scan four = kEight;
  for (std::size_t i = 0; i < 4; ++i) four[i].range_m += 0.2;
  EXPECT_EQ(News(kEight, four), ScanNews::kOther);
  four[4].range_m += 0.2;
  EXPECT_EQ(News(kEight, four), ScanNews::kLeaps);
}

TEST_F(ScanChangeOf, NoLeapIsAsFarAsABodyMovesInATick) {
  Scan nearer = kEight;
  for (Heard& heard : nearer) heard.range_m -= 0.1;
  EXPECT_EQ(News(kEight, nearer), ScanNews::kOther);
  const double max_m = options_.profile.sonar_max_range_m;
  Scan at_the_end;
  for (int i = 0; i < 8; ++i) at_the_end.push_back({i, max_m - 0.1});
  EXPECT_EQ(News({}, at_the_end), ScanNews::kOther);
}

// A transducer that fires once a second may find its echo a metre off.
TEST_F(ScanChangeOf, ALeapIsJudgedByTheTimeSinceTheSensorFired) {
  RangeView view;
  view.Take(ScanOf(10, kEight), SteadyTime{0}, options_.tick_period);
  RangeScan held = ScanOf(29, kEight);
  for (RangeReading& reading : held.readings) reading.tick = Tick{10};
  view.Take(held, SteadyTime{0}, options_.tick_period);
  Scan further = kEight;
  for (Heard& heard : further) heard.range_m += 1;
  EXPECT_EQ(ChangeOf(view, ScanOf(30, further), options_, ConesOf(options_.profile)).news,
            ScanNews::kOther);
}

}  // namespace
}  // namespace giveway

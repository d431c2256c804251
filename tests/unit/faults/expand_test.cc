// How the rules of a fault file are expanded, case by case.
#include "services/faults/expand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/unit/faults/fault_lists.h"

namespace giveway::faults {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Schedule ScheduleOf(const FaultFile& file, const Course& course = kHour,
                    std::uint32_t vehicles = 20) {
  const Expansion expansion = Expand(file, course, Fleet(vehicles));
  EXPECT_THAT(expansion.refused, IsEmpty());
  return expansion.schedule;
}

std::vector<Refusal> RefusedOf(const FaultFile& file, const Course& course = kHour) {
  return Expand(file, course, Fleet(4)).refused;
}

TEST(Expand, AFileWithoutRulesMakesNothing) { EXPECT_THAT(ScheduleOf({}), IsEmpty()); }

TEST(Expand, AtRulesAreSortedAndFilled) {
  const Schedule schedule = ScheduleOf(
      {.at = {At("b", Kind::kLoss, Vehicle(2), 20, 5), At("a", Kind::kKill, Vehicle(1), 10, 0)}});
  ASSERT_THAT(schedule, SizeIs(2));
  EXPECT_EQ(schedule[0], (Fault{"a", 0, 10, 0, Kind::kKill, Vehicle(1), {}}));
  EXPECT_EQ(schedule[1], (Fault{"b", 0, 20, 5, Kind::kLoss, Vehicle(2), {.probability = 0.2}}));
}

TEST(Expand, ThereMustBeSuchAVehicle) {
  FaultFile file{.at = {At("a", Kind::kPause, Vehicle(9), 10, 1)}};
  file.at[0].line = 7;
  EXPECT_THAT(RefusedOf(file),
              ElementsAre(AllOf(Field(&Refusal::rule, "a"), Field(&Refusal::line, 7),
                                Field(&Refusal::field, "vehicle"),
                                Field(&Refusal::message, HasSubstr("no vehicle 9: the fleet has 4 "
                                                                   "vehicles, 1 to 4")))));
  const Targets named{Targets::What::kNamed, {VehicleId{2}, VehicleId{5}}};
  EXPECT_THAT(RefusedOf({.random = {Randomly("r", Kind::kPause, 60, 1, 1, named)}}),
              ElementsAre(Field(&Refusal::message, HasSubstr("no vehicle 5"))));
  FaultFile cut{.at = {At("cut", Kind::kOneWayCut, Vehicle(1), 1, 1)}};
  cut.at[0].parameters.from = VehicleId{6};
  EXPECT_THAT(RefusedOf(cut), ElementsAre(Field(&Refusal::field, "from")));
  EXPECT_THAT(Expand({.random = {Randomly("r", Kind::kPause, 60, 1, 1)}}, kHour, {}).refused,
              ElementsAre(Field(&Refusal::message, HasSubstr("no vehicles"))));
}

TEST(Expand, AnAtRuleThatDoesNotEndInTimeIsRefused) {
  const Course course{.duration_s = 60, .healing_s = 15};
  EXPECT_THAT(RefusedOf({.at = {At("a", Kind::kPause, Vehicle(1), 40, 5)}}, course), IsEmpty());
  EXPECT_THAT(RefusedOf({.at = {At("a", Kind::kPause, Vehicle(1), 40.001, 5)}}, course),
              ElementsAre(AllOf(Field(&Refusal::field, "time_s"),
                                Field(&Refusal::message, HasSubstr("heals from 45 s on")))));
}

TEST(Expand, TwoAtRulesThatExcludeEachOtherAreRefusedAndBothNamed) {
  FaultFile file{.at = {At("stand", Kind::kPause, Vehicle(1), 10, 5),
                        At("die", Kind::kKill, Vehicle(1), 12, 0)}};
  file.at[0].line = 3;
  file.at[1].line = 4;
  EXPECT_THAT(
      RefusedOf(file),
      ElementsAre(AllOf(Field(&Refusal::rule, "die"), Field(&Refusal::line, 4),
                        Field(&Refusal::message, AllOf(HasSubstr("stand ("), HasSubstr("line 3"),
                                                       HasSubstr("exclude each other"))))));
}

// All pairs of a few thousand took gigabytes.
TEST(Expand, OfVeryManyThatExcludeEachOtherTheFirstAreNamedAndTheRestCounted) {
  FaultFile file;
  for (int i = 0; i < 50; ++i) file.at.push_back(At("stand", Kind::kPause, Vehicle(1), 10, 5));
  const auto refused = RefusedOf(file);
  ASSERT_THAT(refused, SizeIs(100));
  EXPECT_THAT(refused.back(), Field(&Refusal::message, HasSubstr("; and 1125 more pairs do")));
}

// Whatever else is refused, one pair at least is named.
TEST(Expand, PairsAreNamedNextToManyOtherRefusals) {
  FaultFile file;
  for (int i = 0; i < 120; ++i) {
    file.at.push_back(At("absent", Kind::kPause, Vehicle(9), 10.0 * i, 1));
  }
  file.at.push_back(At("a", Kind::kPause, Vehicle(1), 10, 5));
  file.at.push_back(At("b", Kind::kPause, Vehicle(1), 12, 5));
  EXPECT_THAT(RefusedOf(file).back(), Field(&Refusal::message, HasSubstr("exclude each other")));
}

TEST(Expand, NoVehicleIsCutFromItself) {
  FaultFile planned{.at = {At("cut", Kind::kOneWayCut, Vehicle(1), 1, 1)}};
  planned.at[0].parameters.from = VehicleId{1};
  EXPECT_THAT(RefusedOf(planned), ElementsAre(Field(&Refusal::field, "from")));
  RandomRule drawn = Randomly("cuts", Kind::kOneWayCut, 10, 1, 1);
  drawn.parameters.from = VehicleId{3};
  const Schedule schedule = ScheduleOf({.random = {drawn}});
  EXPECT_GT(schedule.size(), 50U);
  for (const Fault& fault : schedule) EXPECT_NE(fault.target.vehicle, VehicleId{3});
}

TEST(Expand, ARandomFaultMakesWayToAnAtRuleAndToAnEarlierOne) {
  const Targets one{Targets::What::kNamed, {VehicleId{1}}};
  const FaultFile file{.at = {At("planned", Kind::kPause, Vehicle(1), 100, 3000)},
                       .random = {Randomly("r", Kind::kPause, 20, 15, 15, one)}};
  const Expansion expansion = Expand(file, kHour, Fleet(4));
  ASSERT_THAT(expansion.left_out, SizeIs(1));
  EXPECT_EQ(expansion.left_out[0].rule, "r");
  EXPECT_GT(expansion.left_out[0].excluded, 100U);
  double before_s = -1;
  for (const Fault& fault : expansion.schedule) {
    if (fault.rule == "planned") continue;
    EXPECT_TRUE(fault.EndsAt_s() < 100 || fault.at_s > 3100);
    EXPECT_GT(fault.at_s, before_s);
    before_s = fault.EndsAt_s();
  }
}

TEST(Expand, OfTwoThatExcludeEachOtherTheEarlierStaysButAKillBeforeAny) {
  const Targets one{Targets::What::kNamed, {VehicleId{1}}};
  const RandomRule pauses = Randomly("pauses", Kind::kPause, 100, 3000, 3000, one);
  const Schedule paused = ScheduleOf({.random = {pauses}});
  ASSERT_THAT(paused, SizeIs(1));
  EXPECT_EQ(paused[0].nth, 0U);
  RandomRule kill = Randomly("kill", Kind::kKill, 1000, 0, 0, one);
  kill.at_most = 1;
  const Schedule killed = ScheduleOf({.random = {pauses, kill}});
  ASSERT_THAT(killed, SizeIs(1));
  EXPECT_GT(killed[0].at_s, paused[0].at_s);
  EXPECT_EQ(killed[0].kind, Kind::kKill);
}

TEST(Expand, AKilledVehicleGetsNothingMore) {
  const Targets one{Targets::What::kNamed, {VehicleId{1}}};
  const FaultFile file{.at = {At("die", Kind::kKill, Vehicle(1), 1800, 0)},
                       .random = {Randomly("r", Kind::kLoss, 30, 1, 2, one)}};
  for (const Fault& fault : ScheduleOf(file)) EXPECT_LE(fault.at_s, 1800);
}

TEST(Expand, RandomFaultsComeAsOftenAsWasAskedFor) {
  const Schedule schedule = ScheduleOf(
      {.random = {Randomly("r", Kind::kSharedMemoryGone, 10, 0, 0, {Targets::What::kAll, {}})}},
      {.duration_s = 100'000, .warm_up_s = 0, .healing_s = 0});
  // Of 10 000 events: five standard deviations.
  EXPECT_NEAR(static_cast<double>(schedule.size()), 10'000, 5 * 100);
  // Gaps of an exponential distribution: a share 1/e is longer than the mean.
  std::size_t longer = 0;
  for (std::size_t i = 1; i < schedule.size(); ++i) {
    longer += schedule[i].at_s - schedule[i - 1].at_s > 10 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(longer) / static_cast<double>(schedule.size()), std::exp(-1),
              5 * 0.005);
}

TEST(Expand, LengthsAndVehiclesAreDrawnEvenly) {
  const Schedule schedule = ScheduleOf({.random = {Randomly("r", Kind::kLoss, 20, 0.001, 0.101)}},
                                       {.duration_s = 100'000, .warm_up_s = 0, .healing_s = 0}, 4);
  std::map<VehicleId, std::size_t> counts;
  double sum_s = 0;
  for (const Fault& fault : schedule) {
    ++counts[fault.target.vehicle];
    sum_s += fault.for_s;
  }
  ASSERT_THAT(counts, SizeIs(4));
  const auto all = static_cast<double>(schedule.size());
  EXPECT_NEAR(sum_s / all, 0.051, 5 * 0.029 / std::sqrt(all));
  for (const auto& [vehicle, count] : counts) {
    EXPECT_NEAR(static_cast<double>(count) / all, 0.25, 5 * std::sqrt(0.25 * 0.75 / all));
  }
}

TEST(Expand, EveryVehicleIsMetAtOnceEachByItself) {
  const Schedule schedule = ScheduleOf(
      {.random = {Randomly("r", Kind::kLoss, 600, 1, 2, {Targets::What::kEveryVehicle, {}})}},
      kHour, 3);
  ASSERT_GE(schedule.size(), 6U);
  ASSERT_EQ(schedule.size() % 3, 0U);
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    EXPECT_EQ(schedule[i].nth, i);
    EXPECT_EQ(schedule[i].target, Vehicle(static_cast<std::uint32_t>(1 + i % 3)));
    EXPECT_EQ(schedule[i].at_s, schedule[i - i % 3].at_s);
    EXPECT_EQ(schedule[i].for_s, schedule[i - i % 3].for_s);
  }
}

TEST(Expand, AtMostSoManyTimes) {
  RandomRule rule = Randomly("r", Kind::kLoss, 10, 1, 2);
  const Schedule all = ScheduleOf({.random = {rule}});
  rule.at_most = 5;
  const Schedule some = ScheduleOf({.random = {rule}});
  ASSERT_THAT(some, SizeIs(5));
  EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
}

TEST(Expand, NothingRandomBeginsInTheWarmUpOrLastsIntoTheHealing) {
  const Course course{.seed = 5, .duration_s = 100, .warm_up_s = 30, .healing_s = 40};
  const Expansion expansion =
      Expand({.random = {Randomly("r", Kind::kLoss, 0.5, 1, 20)}}, course, Fleet(4));
  ASSERT_THAT(expansion.left_out, SizeIs(1));
  EXPECT_GT(expansion.left_out[0].too_late, 0U);
  ASSERT_FALSE(expansion.schedule.empty());
  for (const Fault& fault : expansion.schedule) {
    EXPECT_GE(fault.at_s, 30);
    EXPECT_LE(fault.EndsAt_s(), 60);
  }
}

TEST(Expand, TooManyAreRefused) {
  const RandomRule rule = Randomly("r", Kind::kLoss, 0.1, 0.001, 0.001, {Targets::What::kAll, {}});
  EXPECT_THAT(RefusedOf({.random = {rule}}, {.duration_s = 30 * 86400}),
              ElementsAre(Field(&Refusal::message, HasSubstr("more than 1000000"))));
}

TEST(Expand, FlappingHasItsBound) {
  FaultFile file{.at = {At("a", Kind::kFlapping, Vehicle(1), 1, 101)}};
  file.at[0].parameters.period_s = 0.1;
  EXPECT_THAT(RefusedOf(file), ElementsAre(Field(&Refusal::message, HasSubstr("1000 times"))));
  file.at[0].parameters.period_s = 0.2;
  EXPECT_THAT(RefusedOf(file), IsEmpty());
}

TEST(Expand, TimesAreWholeMilliseconds) {
  for (const Fault& fault : ScheduleOf({.random = {Randomly("r", Kind::kLoss, 10, 0.5, 2)}})) {
    EXPECT_EQ(std::round(fault.at_s * 1000) / 1000, fault.at_s);
    EXPECT_EQ(std::round(fault.for_s * 1000) / 1000, fault.for_s);
  }
}

// Guards every list that was ever written into a report.
TEST(Expand, ASeedMeansTheSameListForEver) {
  const Schedule schedule = ScheduleOf({.random = {Randomly("storm", Kind::kLoss, 600, 1, 9)}});
  ASSERT_GE(schedule.size(), 2U);
  EXPECT_EQ(Line(schedule[0]), "365.623 s for 4.992 s: vehicle 20: loss probability=0.2");
  EXPECT_EQ(Line(schedule[1]), "1174.28 s for 8.236 s: vehicle 17: loss probability=0.2");
}

}  // namespace
}  // namespace giveway::faults

// Which differences of two soaks are called worse, and that equal ones are not.
#include "services/fleetctl/report/report_compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "services/fleetctl/report/report_show.h"
#include "tests/unit/fleetctl/soak/soak_results.h"

namespace giveway::fleetctl {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> Changed(const SoakComparison& comparison, Change change) {
  std::vector<std::string> names;
  for (const ComparedFigure& figure : comparison.figures) {
    if (figure.change == change) names.push_back(figure.what);
  }
  return names;
}

std::vector<std::string> Worse(const SoakResult& before, const SoakResult& after) {
  return Changed(Compare(before, after), Change::kWorse);
}

TEST(ComparedSoaks, EqualOnesAreSeldomCalledWorse) {
  int worse = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto names = Worse(SampleSoak(seed), SampleSoak(seed + 1000));
    if (!names.empty()) ++worse;
  }
  RecordProperty("worse_of_200", worse);
  EXPECT_LE(worse, 3);
}

TEST(ComparedSoaks, OneIsNotWorseThanItself) {
  EXPECT_THAT(Worse(SampleSoak(1), SampleSoak(1)), IsEmpty());
}

TEST(ComparedSoaks, OlderBeaconsAreFound) {
  SoakResult after = SampleSoak(2);
  Random random(9);
  after.histograms[1] = SampleHistogram("beacon_age", &random, 45, 12);
  EXPECT_THAT(Worse(SampleSoak(1), after), Contains("beacon_age, median"));
  EXPECT_THAT(Changed(Compare(after, SampleSoak(1)), Change::kBetter),
              Contains("beacon_age, median"));
  EXPECT_THAT(Worse(after, SampleSoak(1)), IsEmpty());
}

TEST(ComparedSoaks, ALongerTailIsFound) {
  SoakResult after = SampleSoak(2);
  after.histograms[0].histogram.Add(400'000'000, 90);
  EXPECT_THAT(Worse(SampleSoak(1), after), ElementsAre("reaction, 99 %"));
}

// A significant difference, but too small to matter.
TEST(ComparedSoaks, ASmallChangeIsNoneHoweverSure) {
  SoakResult before = SampleSoak(1);
  SoakResult after = SampleSoak(2);
  before.ran_s = after.ran_s = 1e6;
  before.histograms = after.histograms = {{.name = "reaction"}};
  before.histograms[0].histogram.Add(100'000'000, 1'000'000);
  after.histograms[0].histogram.Add(103'000'000, 1'000'000);
  EXPECT_THAT(Worse(before, after), IsEmpty());
}

TEST(ComparedSoaks, ALeakIsFoundByItsProcess) {
  SoakResult after = SampleSoak(2);
  Random random(9);
  after.slopes[2] = SampleSlope("vehicle-3", &random, 1500);
  MarkLeaks(&after.slopes, 0);
  EXPECT_THAT(Worse(SampleSoak(1), after),
              AllOf(Contains("vehicle-3 private_bytes"),
                    Contains("vehicle-3 private_bytes an hour"), Not(Contains(HasSubstr("-4")))));
}

TEST(ComparedSoaks, LaterDetectionAndRecoveryAreFoundByKind) {
  SoakResult after = SampleSoak(2);
  for (SoakFault& fault : after.faults) {
    if (fault.kind == "pause") fault.noticed_after_s = *fault.noticed_after_s + 0.15;
    if (fault.kind == "kill") fault.recovered_after_s = *fault.recovered_after_s + 1;
  }
  EXPECT_THAT(Worse(SampleSoak(1), after),
              ElementsAre("kill, recovered after", "pause, noticed after"));
}

TEST(ComparedSoaks, FaultsThatNoLongerHaveAnEffectAreFound) {
  SoakResult after = SampleSoak(2);
  for (SoakFault& fault : after.faults) fault.observed = fault.kind == "pause";
  EXPECT_THAT(Worse(SampleSoak(1), after), ElementsAre("kill, without effect"));
}

TEST(ComparedSoaks, MoreViolationsAreFoundAndOneMoreIsChance) {
  SoakResult before = SampleSoak(1);
  SoakResult after = SampleSoak(2);
  before.violations.resize(2, {1, VehicleId{1}, kNoVehicle, "order", "", ""});
  before.violations_counted = 2;
  after.violations.resize(3, before.violations[0]);
  after.violations_counted = 3;
  EXPECT_THAT(Worse(before, after), IsEmpty());
  after.violations.resize(40, before.violations[0]);
  after.violations_counted = 40;
  EXPECT_THAT(Worse(before, after), ElementsAre("violations: order", "violations"));
}

// Four times the hours, four times the near misses: nothing is worse.
TEST(ComparedSoaks, CountsAreOverTime) {
  SoakResult longer = SampleSoak(2);
  longer.ran_s = 4 * 180;
  longer.near_misses_counted = 120;
  EXPECT_THAT(Worse(SampleSoak(1), longer), IsEmpty());
  longer.near_misses_counted = 300;
  EXPECT_THAT(Worse(SampleSoak(1), longer), ElementsAre("near misses"));
}

TEST(ComparedSoaks, AVerdictThatFellIsWorseWithoutATest) {
  SoakResult after = SampleSoak(1);
  after.verdict = SoakVerdict::kFailed;
  const SoakComparison comparison = Compare(SampleSoak(1), after);
  EXPECT_TRUE(comparison.AnyWorse());
  EXPECT_EQ(comparison.figures[0].what, "verdict");
  EXPECT_FALSE(comparison.figures[0].p);
}

TEST(ComparedSoaks, SamplesNotAccountedForAreWorseWithoutATest) {
  SoakResult after = SampleSoak(1);
  after.accounting[0].lost = 9;
  EXPECT_THAT(Worse(SampleSoak(1), after), ElementsAre("accounting, pairs that differ"));
}

TEST(ComparedSoaks, WhatIsNotAlikeIsRefusedAllAtOnce) {
  SoakResult other = SampleSoak(1);
  EXPECT_EQ(WhyNotComparable(SampleSoak(1), other), "");
  other.scenario = "city_grid";
  other.faults_file = "calm";
  other.vehicles = 9;
  other.verdict = SoakVerdict::kNotRun;
  other.reasons = {"machine_too_busy"};
  EXPECT_THAT(WhyNotComparable(SampleSoak(1), other),
              AllOf(HasSubstr("city_grid"), HasSubstr("calm"), HasSubstr("'9'"),
                    HasSubstr("the second was not run: machine_too_busy")));
}

TEST(ComparisonShown, NoLineIsLongerThanATerminal) {
  SoakResult after = SampleSoak(2);
  after.verdict = SoakVerdict::kFailed;
  Random random(9);
  after.slopes[2] = SampleSlope("vehicle-3", &random, 1500);
  MarkLeaks(&after.slopes, 0);
  SoakComparison comparison = Compare(SampleSoak(1), after);
  comparison.figures.push_back({std::string(200, 'n'), "1", "2", Change::kWorse, 0.002});
  const std::string text = ToText(comparison, true);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  EXPECT_THAT(text, AllOf(HasSubstr("worse  verdict"), HasSubstr("0.0020")));
  EXPECT_THAT(ToText(comparison, false),
              AllOf(Not(HasSubstr("\nsame ")), HasSubstr("(--all shows them)")));
  EXPECT_THAT(ToJson(comparison), AllOf(HasSubstr("{\"worse\":true,\"figures\":[{"),
                                        HasSubstr("\"what\":\"verdict\",\"before\":\"passed\"")));
}

}  // namespace
}  // namespace giveway::fleetctl

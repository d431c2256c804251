// Which differences of two soaks are called worse, and that equal ones are not.
#include "services/fleetctl/report/report_compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "services/fleetctl/report/report_show.h"
#include "services/fleetctl/soak/soak_phases.h"
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

// As soaks are: a burst concerns many values at a time, and all that it delays is late together.
SoakResult ClusteredSoak(std::uint64_t seed) {
  SoakResult result = SampleSoak(seed);
  Random random(seed);
  SoakHistogram age{.name = "beacon_age"};
  BlockCounts spent(result.block_s);
  for (std::size_t block = 0; block < kSoakBlocks; ++block) {
    const bool burst = random.Uniform(0, 1) < 0.2;
    std::vector<double> values_ms(150, 50.0);
    const auto hit = static_cast<std::size_t>(5 + random.Uniform(0, 30));
    for (std::size_t i = 0; burst && i < hit; ++i) values_ms[i] = 150;
    AddBlock(&age, values_ms);
    const double reactions = burst ? random.Uniform(0, 40) : 0;
    spent.Note(static_cast<double>(block) * result.block_s, static_cast<std::uint64_t>(reactions));
  }
  result.histograms[1] = age;
  result.budget_spent_by_block = spent.Counts();
  for (const std::uint64_t count : spent.Counts()) result.budget_spent += count;
  SoakHistogram healing{.name = "healing"};
  healing.histogram.Add(random.Uniform(0, 1) < 0.5 ? 100'000'000 : 150'000'000, kSampleVehicles);
  result.histograms.push_back(healing);
  // Eight faults of a kind in each of a few blocks, all over with the last of them.
  for (std::size_t cluster = 0; cluster < 6; ++cluster) {
    const double recovered_s = 0.5 + random.Uniform(0, 2);
    for (std::uint32_t nth = 0; nth < 8; ++nth) {
      result.faults.push_back(SampleFault(nth, &random));
      result.faults.back().kind = "loss";
      result.faults.back().at_s = 30 + 20.0 * static_cast<double>(cluster) + 0.1 * nth;
      result.faults.back().recovered_after_s = recovered_s;
    }
  }
  return result;
}

TEST(ComparedSoaks, ValuesInClustersAreNoMoreEvidenceThanTheClusters) {
  int worse = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    if (!Worse(ClusteredSoak(seed), ClusteredSoak(seed + 1000)).empty()) ++worse;
  }
  RecordProperty("worse_of_200", worse);
  EXPECT_LE(worse, 3);
}

TEST(ComparedSoaks, OneEventIsShownAndNotTested) {
  SoakResult before = SampleSoak(1);
  SoakResult after = SampleSoak(1);
  before.histograms = after.histograms = {{.name = "healing"}};
  before.histograms[0].histogram.Add(100'000'000, kSampleVehicles);
  after.histograms[0].histogram.Add(150'000'000, kSampleVehicles);
  const SoakComparison comparison = Compare(before, after);
  EXPECT_FALSE(comparison.AnyWorse());
  EXPECT_THAT(Changed(comparison, Change::kUntested),
              ElementsAre("healing, mean", "healing, median", "healing, 99 %"));
  EXPECT_EQ(comparison.figures[0].after, "150.0 ms");
  EXPECT_FALSE(comparison.figures[0].p);
  EXPECT_THAT(ToText(comparison, false), HasSubstr("3 untested: all values stem from one event"));
  EXPECT_THAT(ToJson(comparison), HasSubstr("\"why_untested\":\"all values"));
}

TEST(ComparedSoaks, WithoutBlocksHistogramsAndCountsAreNotTested) {
  SoakResult after = SampleSoak(2);
  after.block_s = 0;
  after.near_misses_counted = 300;
  const SoakComparison comparison = Compare(SampleSoak(1), after);
  EXPECT_FALSE(comparison.AnyWorse());
  EXPECT_THAT(Changed(comparison, Change::kUntested), Contains("near misses"));
  EXPECT_THAT(ToText(comparison, false), HasSubstr("untested: a report without blocks of time"));
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

// Virtual time knows whole ticks alone: median and 99 % may stay where the mean does not.
TEST(ComparedSoaks, MoreOldBeaconsBelowTheTailAreFoundByTheirMean) {
  SoakResult before = SampleSoak(1);
  SoakResult after = SampleSoak(2);
  for (SoakResult* result : {&before, &after}) {
    Random random(result->seed);
    SoakHistogram age{.name = "beacon_age"};
    for (std::size_t block = 0; block < kSoakBlocks; ++block) {
      std::vector<double> values_ms(150, 50.0);
      const double old = random.Uniform(10, 20) + (result == &after ? 20 : 0);
      for (int i = 0; i < old; ++i) values_ms[static_cast<std::size_t>(i)] = 150;
      AddBlock(&age, values_ms);
    }
    result->histograms[1] = age;
  }
  EXPECT_THAT(Worse(before, after), ElementsAre("beacon_age, mean"));
}

TEST(ComparedSoaks, ALongerTailIsFound) {
  SoakResult after = SampleSoak(2);
  after.histograms[0].histogram.Add(400'000'000, 90);
  for (BlockSummary& block : after.histograms[0].blocks) block.p99 = 400'000'000;
  EXPECT_THAT(Worse(SampleSoak(1), after), ElementsAre("reaction, 99 %"));
}

// A significant difference, but too small to matter.
TEST(ComparedSoaks, ASmallChangeIsNoneHoweverSure) {
  SoakResult before = SampleSoak(1);
  SoakResult after = SampleSoak(2);
  before.histograms = after.histograms = {{.name = "reaction"}};
  for (std::size_t block = 0; block < kSoakBlocks; ++block) {
    AddBlock(&before.histograms[0], std::vector(1000, 100.0));
    AddBlock(&after.histograms[0], std::vector(1000, 103.0));
  }
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

// The memory of a process fills up in its first minutes: a short life seemed to leak.
TEST(ComparedSoaks, LivesThatAreShortOrOfOtherLengthsAreNotTested) {
  SoakResult after = SampleSoak(2);
  Random random(9);
  after.slopes[2] = SampleSlope("vehicle-3", &random, 1500);
  const std::string name = "vehicle-3 private_bytes an hour";
  EXPECT_THAT(Worse(SampleSoak(1), after), Contains(name));
  SoakResult before = SampleSoak(1);
  before.slopes[2].slope.spans_s = after.slopes[2].slope.spans_s = kLeastLeakSpan_s - 1;
  EXPECT_THAT(Worse(before, after), Not(Contains(name)));
  EXPECT_THAT(Changed(Compare(before, after), Change::kUntested), Contains(name));
  after.slopes[2].slope.spans_s = 600;
  EXPECT_THAT(Changed(Compare(SampleSoak(1), after), Change::kUntested), Contains(name));
  EXPECT_THAT(Changed(Compare(after, SampleSoak(1)), Change::kUntested), Contains(name));
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
  for (SoakFault& fault : after.faults) {
    fault.observed = fault.kind == "pause";
    if (!fault.observed) fault.observed_how.clear();
  }
  EXPECT_THAT(Worse(SampleSoak(1), after), ElementsAre("kill, without effect"));
  for (SoakFault& fault : after.faults) {
    if (!fault.observed) fault.observed_how = "there was nothing to act on";
  }
  EXPECT_THAT(Worse(SampleSoak(1), after), IsEmpty());
}

// The first 5000 of a longer list are alike, whatever came later.
TEST(ComparedSoaks, FaultsThatAreNotAllListedAreNotTested) {
  SoakResult after = SampleSoak(1);
  after.faults_counted = after.faults.size();
  EXPECT_THAT(Changed(Compare(SampleSoak(1), after), Change::kUntested), IsEmpty());
  after.faults_counted = 9000;
  for (const auto& [one, two] :
       {std::pair(SampleSoak(1), after), std::pair(after, SampleSoak(1))}) {
    const SoakComparison comparison = Compare(one, two);
    EXPECT_THAT(
        Changed(comparison, Change::kUntested),
        ElementsAre("kill, noticed after", "kill, recovered after", "kill, noticed late",
                    "kill, without effect", "pause, noticed after", "pause, recovered after",
                    "pause, noticed late", "pause, without effect"));
    EXPECT_THAT(ToText(comparison, false), HasSubstr("untested: not all faults are listed"));
  }
}

void Violate(SoakResult* result, int times, double every_s) {
  for (int i = 0; i < times; ++i) {
    result->violations.push_back({every_s * i, VehicleId{1}, kNoVehicle, "order", "", ""});
  }
  result->violations_counted = result->violations.size();
}

TEST(ComparedSoaks, MoreViolationsAreFoundAndOneMoreIsChance) {
  SoakResult before = SampleSoak(1);
  SoakResult after = SampleSoak(2);
  Violate(&before, 2, 20);
  Violate(&after, 3, 20);
  EXPECT_THAT(Worse(before, after), IsEmpty());
  Violate(&after, 37, 4.8);
  EXPECT_THAT(Worse(before, after), ElementsAre("violations", "violations: order"));
}

// Forty contacts of one pile-up are one event.
TEST(ComparedSoaks, ViolationsOfOneMomentAreOneEvent) {
  SoakResult after = SampleSoak(2);
  Violate(&after, 40, 0.01);
  EXPECT_THAT(Worse(SampleSoak(1), after), IsEmpty());
}

TEST(ComparedSoaks, ViolationsThatAreNotListedAreNotTested) {
  SoakResult after = SampleSoak(2);
  Violate(&after, 40, 4);
  after.violations_counted = 6000;
  EXPECT_THAT(Changed(Compare(SampleSoak(1), after), Change::kUntested), Contains("violations"));
}

TEST(ComparedSoaks, NearMissesAreComparedBlockByBlock) {
  SoakResult after = SampleSoak(2);
  after.near_misses_counted = 130;
  after.near_misses_by_block[3] += 100;
  EXPECT_THAT(Worse(SampleSoak(1), after), IsEmpty());
  for (std::uint64_t& count : after.near_misses_by_block) count += 5;
  EXPECT_THAT(Worse(SampleSoak(1), after), ElementsAre("near misses"));
}

// Blocks of other lengths have other counts, and other tails.
TEST(ComparedSoaks, OfOtherDurationsHistogramsAndCountsAreNotTested) {
  SoakResult longer = SampleSoak(2);
  longer.planned_s = longer.ran_s = 4 * 180;
  longer.block_s = BlockSeconds(longer.ran_s);
  longer.near_misses_counted = 300;
  const SoakComparison comparison = Compare(SampleSoak(1), longer);
  EXPECT_FALSE(comparison.AnyWorse());
  EXPECT_THAT(Changed(comparison, Change::kUntested), Contains("near misses"));
  EXPECT_THAT(ToText(comparison, false), HasSubstr("untested: soaks of different durations"));
}

// Of one that ended early only the blocks before its end say anything.
TEST(ComparedSoaks, BlocksThatOneDidNotReachAreLeftOut) {
  SoakResult before = SampleSoak(1);
  before.ran_s = 18;
  before.near_misses_by_block.resize(2);
  SoakResult after = SampleSoak(1);
  for (std::size_t block = 2; block < kSoakBlocks; ++block) {
    after.near_misses_by_block[block] += 50 + block % 2;
  }
  const SoakComparison comparison = Compare(before, after);
  const auto near = std::ranges::find(comparison.figures, "near misses", &ComparedFigure::what);
  ASSERT_NE(near, comparison.figures.end());
  EXPECT_EQ(near->p, 1);  // until then they are alike
}

TEST(ComparedSoaks, AVerdictThatFellIsWorseWithoutATest) {
  SoakResult after = SampleSoak(1);
  after.verdict = SoakVerdict::kFailed;
  const SoakComparison comparison = Compare(SampleSoak(1), after);
  EXPECT_TRUE(comparison.AnyWorse());
  EXPECT_EQ(comparison.figures[0].what, "verdict");
  EXPECT_FALSE(comparison.figures[0].p);
}

// A nightly soak that was cut off in its first minute passed as equal to the last whole one.
TEST(ComparedSoaks, OneThatWasInterruptedIsNotEqualToOneThatPassed) {
  SoakResult after = SampleSoak(1);
  after.verdict = SoakVerdict::kInterrupted;
  after.ran_s = 1;
  after.near_misses_counted = 0;
  const SoakComparison comparison = Compare(SampleSoak(1), after);
  EXPECT_TRUE(comparison.AnyWorse());
  EXPECT_THAT(Changed(comparison, Change::kUntested), Contains("near misses"));
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
  EXPECT_THAT(text, AllOf(HasSubstr("worse    verdict"), HasSubstr("0.0020")));
  EXPECT_THAT(ToText(comparison, false),
              AllOf(Not(HasSubstr("\nsame ")), HasSubstr("(--all shows them)")));
  EXPECT_THAT(ToJson(comparison), AllOf(HasSubstr("{\"worse\":true,\"figures\":[{"),
                                        HasSubstr("\"what\":\"verdict\",\"before\":\"passed\"")));
}

}  // namespace
}  // namespace giveway::fleetctl

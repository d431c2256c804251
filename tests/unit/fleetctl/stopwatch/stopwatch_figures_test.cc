#include "services/fleetctl/stopwatch/stopwatch_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "services/fleetctl/stopwatch/stopwatch_show.h"
#include "tests/unit/fleetctl/stopwatch/stopwatch_limits.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// One trial, one watcher; everything that must see it does, at its promise.
Trial PerfectTrial(Fault fault, const Limits& limits) {
  Trial trial{fault, 1, {}};
  for (std::size_t i = 0; i < kMechanisms; ++i) {
    const auto mechanism = static_cast<Mechanism>(i);
    if (DutyOf(fault, mechanism, limits) != Duty::kMust) continue;
    trial.sightings.push_back({mechanism, PromisedWithin(mechanism, limits), milliseconds(2)});
  }
  return trial;
}

Sighting* Find(Trial* trial, Mechanism mechanism) {
  return &*std::ranges::find(trial->sightings, mechanism, &Sighting::mechanism);
}

StopwatchReport ReportOf(const std::vector<Trial>& trials, const Limits& limits) {
  StopwatchReport report;
  report.limits = limits;
  report.cells = EvaluateTrials(trials, limits);
  return report;
}

TEST(StopwatchFigures, PercentilesAreByNearestRank) {
  std::vector<Nanoseconds> times;
  for (int i = 200; i >= 1; --i) times.push_back(milliseconds(i));
  const Distribution all = DistributionOf(times);
  EXPECT_EQ(all.n, 200U);
  EXPECT_EQ(all.min, milliseconds(1));
  EXPECT_EQ(all.p50, milliseconds(100));
  EXPECT_EQ(all.p99, milliseconds(198));
  EXPECT_EQ(all.max, milliseconds(200));
  EXPECT_EQ(DistributionOf({milliseconds(7)}).p50, milliseconds(7));
  EXPECT_EQ(DistributionOf({}).n, 0U);
}

TEST(StopwatchFigures, WhatIsSeenWithinThePromiseIsKept) {
  for (std::size_t i = 0; i < kFaults; ++i) {
    const Trial trial = PerfectTrial(static_cast<Fault>(i), Shipped());
    const StopwatchReport report = ReportOf({trial}, Shipped());
    EXPECT_EQ(report.cells.size(), kMechanisms);
    EXPECT_TRUE(report.Kept()) << Name(trial.fault);
    EXPECT_THAT(Findings(report), IsEmpty());
  }
}

TEST(StopwatchFigures, APauseOfTheMachineExcusesAsMuchAsItLasted) {
  Trial trial = PerfectTrial(Fault::kKill, Shipped());
  Sighting* const deadline = Find(&trial, Mechanism::kDeadline);
  deadline->pause = milliseconds(20);
  deadline->after = milliseconds(245);
  const StopwatchReport excused = ReportOf({trial}, Shipped());
  EXPECT_TRUE(excused.Kept());
  for (const Cell& cell : excused.cells) {
    EXPECT_EQ(cell.excused, cell.mechanism == Mechanism::kDeadline ? 1U : 0U);
  }
  deadline->after = milliseconds(246);
  const StopwatchReport late = ReportOf({trial}, Shipped());
  EXPECT_FALSE(late.Kept());
  EXPECT_THAT(Findings(late),
              ElementsAre("kill: deadline saw 1 of 1 later than the 225 ms promised and the pause "
                          "then, by up to 1.0 ms"));
}

TEST(StopwatchFigures, TheLongPauseOfOneSightingExcusesNoOther) {
  Trial paused = PerfectTrial(Fault::kKill, Shipped());
  Find(&paused, Mechanism::kDeadline)->pause = milliseconds(500);
  Trial late = PerfectTrial(Fault::kKill, Shipped());
  Find(&late, Mechanism::kDeadline)->after = milliseconds(300);
  EXPECT_FALSE(ReportOf({paused, late}, Shipped()).Kept());
}

TEST(StopwatchFigures, WhatMustBeSeenAndIsNotIsBroken) {
  Trial trial = PerfectTrial(Fault::kPause, Shipped());
  trial.watchers = 2;
  const StopwatchReport report = ReportOf({trial}, Shipped());
  EXPECT_FALSE(report.Kept());
  EXPECT_THAT(Findings(report), testing::Contains("pause: liveliness did not see 1 of 2"));
}

TEST(StopwatchFigures, WhatMustNotBeSeenAndIsIsBroken) {
  Trial trial = PerfectTrial(Fault::kHung, Shipped());
  trial.sightings.push_back({Mechanism::kLease, seconds(10), milliseconds(2)});
  EXPECT_THAT(Findings(ReportOf({trial}, Shipped())),
              ElementsAre("hung: lease must not see it, and was seen 1 times"));
}

TEST(StopwatchFigures, WhatMayBeSeenIsNeverBroken) {
  Trial trial = PerfectTrial(Fault::kExit, Shipped());
  trial.sightings.push_back({Mechanism::kDeadline, seconds(9), milliseconds(2)});
  EXPECT_TRUE(ReportOf({trial}, Shipped()).Kept());
}

TEST(StopwatchFigures, MaskedLivelinessIsNamed) {
  Limits limits = Shipped();
  limits.asserted = limits.tracked = LivelinessKind::kAutomatic;
  Trial trial = PerfectTrial(Fault::kKill, limits);
  Find(&trial, Mechanism::kLiveliness)->after = seconds(10);
  const std::vector<std::string> findings = Findings(ReportOf({trial}, limits));
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_THAT(findings[1], HasSubstr("Take MANUAL_BY_TOPIC"));
}

TEST(StopwatchFigures, FastDds3IsNotAccusedOfMasking) {
  Limits limits = Shipped();
  limits.asserted = limits.tracked = LivelinessKind::kAutomatic;
  Trial trial = PerfectTrial(Fault::kKill, limits);
  Find(&trial, Mechanism::kLiveliness)->after = seconds(10);
  StopwatchReport report = ReportOf({trial}, limits);
  report.library_major = 3;
  EXPECT_EQ(Findings(report).size(), 1U);
}

// Regression: they were called broken promises.
TEST(StopwatchFigures, TrialsThatCouldNotBeMadeNeitherKeepAPromiseNorBreakOne) {
  StopwatchReport report = ReportOf({PerfectTrial(Fault::kKill, Shipped())}, Shipped());
  report.problems.push_back("cut: interrupted");
  EXPECT_FALSE(report.Kept());
  EXPECT_THAT(StopwatchText(report),
              AllOf(HasSubstr("not tried: cut: interrupted"),
                    HasSubstr("not every trial could be made after"), Not(HasSubstr("BROKEN"))));
  EXPECT_THAT(StopwatchJson(report), AllOf(HasSubstr(R"("verdict":"incomplete")"),
                                           HasSubstr(R"("not_tried":["cut: interrupted"])"),
                                           HasSubstr(R"("findings":[])")));
}

// Regression: with no trial at all promises were called broken, and the exit code was 1.
TEST(StopwatchFigures, WithoutATrialNothingIsKnown) {
  StopwatchReport report = ReportOf({}, Shipped());
  report.problems.push_back("kill: no vehicle came up");
  EXPECT_EQ(report.Verdict(), StopwatchVerdict::kNotRun);
  EXPECT_THAT(StopwatchText(report), HasSubstr("NOT RUN: no trial could be made"));
  EXPECT_THAT(StopwatchJson(report), HasSubstr(R"("verdict":"not_run")"));
  report.interrupted = true;
  EXPECT_EQ(report.Verdict(), StopwatchVerdict::kIncomplete);
}

TEST(StopwatchFigures, ABrokenPromiseIsOneWhateverElseCouldNotBeTried) {
  Trial trial = PerfectTrial(Fault::kHung, Shipped());
  trial.sightings.push_back({Mechanism::kLease, seconds(10), milliseconds(2)});
  StopwatchReport report = ReportOf({trial}, Shipped());
  report.problems.push_back("cut: no vehicle came up");
  report.interrupted = true;
  EXPECT_EQ(report.Verdict(), StopwatchVerdict::kBroken);
}

}  // namespace
}  // namespace giveway::fleetctl

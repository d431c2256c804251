#include "services/fleetctl/soak/verb/soak_resume.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "services/config/problem.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "tests/unit/config/scenario_files.h"
#include "tests/unit/fleetctl/soak/soak_results.h"

namespace giveway::fleetctl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

faults::Fault Beginning(const char* rule, double at_s) {
  faults::Fault fault;
  fault.rule = rule;
  fault.at_s = at_s;
  return fault;
}

TEST(SoakResume, SavingTakesAThousandthOfTheTimeAtMost) {
  EXPECT_EQ(UntilNextSave(std::chrono::milliseconds(5)), std::chrono::seconds(10));
  EXPECT_EQ(UntilNextSave(std::chrono::milliseconds(30)), std::chrono::seconds(30));
}

TEST(SoakResume, TheRestOfAListIsByTheNewFleetsClock) {
  SkippedFaults lost;
  SoakResult so_far;
  so_far.ran_s = 100;
  const faults::Schedule rest = RestOf(
      {Beginning("before", 90), Beginning("lost", 105), Beginning("left", 130)}, so_far, 12, &lost);
  ASSERT_THAT(rest, SizeIs(1));
  EXPECT_EQ(rest[0].rule, "left");
  EXPECT_EQ(rest[0].at_s, 30);
  ASSERT_THAT(lost.Lines(), SizeIs(1));
  EXPECT_THAT(lost.Lines()[0], HasSubstr("lost#0 (kill of vehicle 0 at 105.0 s): fell into"));
}

SoakFault OfWorld(const char* rule, double at_s, std::optional<double> started_s) {
  SoakFault fault{.rule = rule, .at_s = at_s, .kind = "sonar_off", .target = "vehicle 1"};
  fault.observed = started_s.has_value();
  fault.observed_s = started_s;
  return fault;
}

// They were neither carried out nor listed.
TEST(SoakResume, WhatAWorldThatLaggedHadStillToCarryOutIsLeftOut) {
  SoakResult so_far;
  so_far.ran_s = 100;
  so_far.faults = {OfWorld("came", 90, 95), OfWorld("awaited", 98, std::nullopt),
                   OfWorld("left", 130, std::nullopt)};
  so_far.faults_counted = 3;
  faults::Schedule whole{Beginning("came", 90), Beginning("awaited", 98), Beginning("left", 130)};
  for (faults::Fault& fault : whole) fault.kind = faults::Kind::kSonarOff;
  SkippedFaults lost;
  EXPECT_THAT(RestOf(whole, so_far, 12, &lost), SizeIs(1));
  ASSERT_THAT(lost.Lines(), SizeIs(1));
  EXPECT_THAT(lost.Lines()[0], HasSubstr("awaited#0"));
  EXPECT_THAT(lost.Lines()[0], HasSubstr("the world's time lagged"));
  SoakResult rest;
  rest.ran_s = 80;
  rest.faults = {OfWorld("left", 30, 30)};
  rest.faults_counted = 1;
  rest.skipped_counted = lost.Count();
  const SoakResult joined = Joined(so_far, rest);
  EXPECT_THAT(joined.faults, SizeIs(2));
  EXPECT_EQ(joined.faults_counted, 2U) << "of which the summary says how many were seen";
}

TEST(SoakResume, OneThatWasActiveAsTheSoakDiedSaysSo) {
  SoakResult so_far;
  so_far.ran_s = 100;
  so_far.faults = {{.rule = "stop", .at_s = 95, .kind = "pause", .target = "vehicle 1"}};
  const SoakResult joined = Joined(so_far, SoakResult{});
  ASSERT_THAT(joined.faults, SizeIs(1));
  EXPECT_THAT(joined.faults[0].observed_how, HasSubstr("active as the soak died"));
}

TEST(SoakResume, PlannedRestartsAreThoseOfBothLegs) {
  EXPECT_EQ(Joined(SampleSoak(1), SampleSoak(2)).restarts_planned, 24U);
}

TEST(SoakResume, TwoLegsAreOneSoak) {
  SoakResult first = SampleSoak(1);
  SoakResult rest = SampleSoak(2);
  first.ran_s = 100;
  first.planned_s = 280;
  rest.ran_s = 180;
  first.supervisor_cpu_share = 0.14;
  rest.supervisor_cpu_share = 0.28;
  first.skipped_counted = 4;
  rest.skipped_counted = 3;
  first.budget_spent = 1;
  rest.budget_spent = 2;
  rest.narrowest_margin->share_left = 0.1;
  rest.narrowest_margin->time_s = 7;
  const std::uint64_t values = first.histograms[0].histogram.Count();
  const std::size_t before = static_cast<std::size_t>(
      std::ranges::count_if(first.faults, [](const SoakFault& fault) { return fault.at_s < 100; }));
  const SoakResult joined = Joined(first, rest);
  EXPECT_EQ(joined.ran_s, 280);
  EXPECT_EQ(joined.planned_s, 280);
  EXPECT_THAT(joined.faults, SizeIs(before + rest.faults.size()));
  EXPECT_EQ(joined.faults[before].at_s, rest.faults[0].at_s + 100);
  EXPECT_EQ(joined.histograms[0].histogram.Count(), 2 * values);
  EXPECT_EQ(joined.near_misses_counted, 60U);
  EXPECT_EQ(joined.near_misses.back().time_s, rest.near_misses.back().time_s + 100);
  EXPECT_EQ(joined.budget_spent, 3U);
  EXPECT_EQ(joined.skipped_counted, 7U);
  EXPECT_DOUBLE_EQ(joined.supervisor_cpu_share.value_or(0), 0.23);
  EXPECT_EQ(joined.block_s, 0);  // those of two legs are of different lengths
  EXPECT_TRUE(joined.near_misses_by_block.empty());
  EXPECT_TRUE(joined.histograms[0].blocks.empty());
  EXPECT_EQ(joined.narrowest_margin->time_s, 107);
  EXPECT_EQ(joined.verdict, SoakVerdict::kPassed);
  EXPECT_THAT(joined.reasons, ElementsAre("resumed at 100 s"));
  EXPECT_THAT(joined.resumed_at_s, ElementsAre(100));
}

TEST(SoakResume, WhatWasBrokenBeforeStaysBroken) {
  SoakResult first = SampleSoak(1);
  first.violations.push_back({50, VehicleId{1}, kNoVehicle, "contact", "tick 5", ""});
  first.violations_counted = 1;
  EXPECT_EQ(Joined(first, SampleSoak(2)).verdict, SoakVerdict::kFailed);
  EXPECT_THAT(Joined(first, SampleSoak(2)).reasons, ElementsAre("contact: 1", "resumed at 180 s"));
  SoakResult lost = SampleSoak(2);
  lost.verdict = SoakVerdict::kNotRun;
  lost.reasons = {"not all vehicles drove within 60 s"};
  EXPECT_EQ(Joined(first, lost).verdict, SoakVerdict::kNotRun);
  EXPECT_EQ(Joined(first, lost).reasons.front(), "not all vehicles drove within 60 s");
}

// A leg of `ran_s` with so much of it paused, as it is judged by itself.
SoakResult Leg(double ran_s, double paused_s) {
  SoakResult leg = SampleSoak(1);
  leg.planned_s = 1000;
  leg.ran_s = ran_s;
  leg.pauses = {.count = 1, .total_s = paused_s, .share = paused_s / ran_s};
  if (leg.pauses.share > kMostPausedShare) {
    leg.verdict = SoakVerdict::kNotRun;
    leg.reasons = {kTooBusy};
  }
  return leg;
}

TEST(SoakResume, TheMachinesPausesAreJudgedOverBothLegs) {
  EXPECT_EQ(Joined(Leg(500, 30), Leg(500, 0)).verdict, SoakVerdict::kNotRun);
  EXPECT_EQ(Joined(Leg(500, 30), Leg(500, 0)).reasons.front(), kTooBusy);
  EXPECT_EQ(Joined(Leg(970, 0), Leg(30, 2)).verdict, SoakVerdict::kPassed);
  EXPECT_EQ(Joined(Leg(900, 0), Leg(30, 2)).verdict, SoakVerdict::kInterrupted);
}

TEST(SoakResume, CurvesAreByTheTimeOfTheWhole) {
  SoakResult rest = Leg(500, 0);
  rest.slopes.resize(1);
  rest.slopes[0].curve = {{10, 5}};
  EXPECT_EQ(Joined(Leg(500, 0), rest).slopes.back().curve[0].time_s, 510);
}

TEST(SoakResume, AnotherSoakInTheFolderFindsNothingOfTheLastOne) {
  const TempFolder folder;
  for (const char* file : {"so_far.json", kCheckpointFile, "report.json", "report.html"}) {
    std::ofstream(folder.Path() + "/" + file) << "old";
  }
  ForgetSoak(folder.Path());
  EXPECT_TRUE(std::filesystem::is_empty(folder.Path()));
}

TEST(SoakResume, WhatIsSavedComesBackAndIsForgottenWithTheVerdict) {
  const TempFolder folder;
  const SoakResult saved = SampleSoak(3);
  ASSERT_EQ(SaveSoFar(ToJson(saved), folder.Path()), "");
  EXPECT_EQ(ToJson(LoadSoFar(folder.Path())), ToJson(saved));
  EXPECT_NE(SaveSoFar(ToJson(saved), folder.Path() + "/nowhere"), "");
  ForgetSoFar(folder.Path());
  EXPECT_THROW(LoadSoFar(folder.Path()), InputError);
}

// A machine may die while it saves: the file is then the old or the new one.
TEST(SoakResume, IsSavedWholeOrNotAtAll) {
  const TempFolder folder;
  ASSERT_EQ(SaveSoFar(ToJson(SampleSoak(3)), folder.Path()), "");
  ASSERT_EQ(SaveSoFar(ToJson(SampleSoak(4)), folder.Path()), "");
  EXPECT_EQ(LoadSoFar(folder.Path()).seed, 4U);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder.Path())) {
    ++files;
  }
  EXPECT_EQ(files, 1U) << "no temporary file is left";
  std::ofstream(folder.Path() + "/so_far.json") << "{\"format\":1,";
  EXPECT_THROW(LoadSoFar(folder.Path()), InputError);
}

}  // namespace
}  // namespace giveway::fleetctl

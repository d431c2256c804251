#include "services/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace giveway {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

Report Passed() {
  Report report;
  report.scenario = "intersection_yield";
  report.verdict = Verdict::kPassed;
  report.reason = "expectations_met";
  report.min_separation_m = 0.625;
  report.time_to_clear_s = 18.25;
  report.halted = {VehicleId{2}};
  report.arrived = {VehicleId{1}, VehicleId{2}};
  report.beacons_sent = 730;
  report.beacons_received = 728;
  report.reaction_p50_ms = 50.5;
  report.reaction_p99_ms = 51;
  report.reaction_max_ms = 52;
  report.seed = 4294967295U;
  report.domain = 17;
  report.trust = {1, 2, 3, 4, 5};
  report.state_hash = "00ff00ff00ff00ff";
  return report;
}

// Protobuf prints fields with presence after the others; the order means nothing in JSON.
TEST(Report, JsonIsOneObjectOnOneLine) {
  EXPECT_EQ(ToJson(Passed()),
            R"({"scenario":"intersection_yield","verdict":"passed","reason":"expectations_met",)"
            R"("contacts":0,"halted":[2],"arrived":[1,2],"beacons_sent":730,)"
            R"("beacons_received":728,"deadline_missed":0,"liveliness_lost":0,)"
            R"("reaction_ms":{"p50":50.5,"p99":51,"max":52},"tick_overruns":0,)"
            R"("seed":4294967295,"domain":17,"state_hash":"00ff00ff00ff00ff",)"
            R"("first_violations":[],"ticks_judged":0,"ticks_unseen":0,)"
            R"("trust":{"beacon_without_echo":1,"echo_without_beacon":2,"halted_but_closing":3,)"
            R"("jumps":4,"impossible_speeds":5},)"
            R"("min_separation_m":0.625,"time_to_clear_s":18.25})");
}

TEST(Report, JsonHasCountsBeyondThirtyTwoBitsAsNumbers) {
  Report report;
  report.beacons_sent = 900'000'000'000'000;
  report.deadline_missed = 5'000'000'000;
  EXPECT_NE(ToJson(report).find(R"("beacons_sent":900000000000000,)"), std::string::npos)
      << ToJson(report);
  EXPECT_NE(ToJson(report).find(R"("deadline_missed":5000000000,)"), std::string::npos);
}

TEST(Report, JsonPrintsDefaultsAndLeavesOutWhatDoesNotExist) {
  EXPECT_EQ(ToJson(Report{}),
            R"({"scenario":"","verdict":"not_run","reason":"","contacts":0,"halted":[],)"
            R"("arrived":[],"beacons_sent":0,"beacons_received":0,"deadline_missed":0,)"
            R"("liveliness_lost":0,"tick_overruns":0,"seed":0,"domain":0,"state_hash":"",)"
            R"("first_violations":[],"ticks_judged":0,"ticks_unseen":0,)"
            R"("trust":{"beacon_without_echo":0,"echo_without_beacon":0,"halted_but_closing":0,)"
            R"("jumps":0,"impossible_speeds":0}})");
}

TEST(Report, JsonLeavesOutWhatIsNotFinite) {
  Report report;
  report.verdict = Verdict::kFailed;
  report.min_separation_m = std::numeric_limits<double>::quiet_NaN();
  report.time_to_clear_s = std::numeric_limits<double>::infinity();
  report.reaction_max_ms = 3;
  const std::string json = ToJson(report);
  EXPECT_THAT(json, HasSubstr(R"("verdict":"failed")"));
  EXPECT_THAT(json, Not(HasSubstr("min_separation_m")));
  EXPECT_THAT(json, Not(HasSubstr("time_to_clear_s")));
  EXPECT_THAT(json, HasSubstr(R"("reaction_ms":{"max":3})"));
}

TEST(Report, JsonPrintsNoDigitsOfRoundingNoise) {
  Report report;
  report.min_separation_m = 0.34499999999999886;
  EXPECT_THAT(ToJson(report), HasSubstr(R"("min_separation_m":0.345)"));
}

TEST(Report, JsonEscapesAndSurvivesBytesThatAreNoText) {
  Report report;
  report.reason = "a \"quote\"\nand a line";
  EXPECT_THAT(ToJson(report), HasSubstr(R"(a \"quote\"\nand a line)"));
  report.reason = "\xff\xfe";
  EXPECT_THAT(ToJson(report), HasSubstr("\"reason\":\"\xef\xbf\xbd\xef\xbf\xbd\""));
}

TEST(Report, TheExitCodeIsTheVerdict) {
  EXPECT_EQ(ExitCode(Verdict::kPassed), 0);
  EXPECT_EQ(ExitCode(Verdict::kFailed), 1);
  EXPECT_EQ(ExitCode(Verdict::kNotRun), 2);
}

std::size_t LongestLine(const std::string& table) {
  std::istringstream lines(table);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

TEST(Report, NoLineOfTheTableIsLongerThanTheTerminal) {
  Report report = Passed();
  report.reason = "halted [1, 2] instead of [2] and_one_word_that_is_longer_than_a_narrow_terminal";
  for (int columns = 24; columns <= 200; ++columns) {
    EXPECT_LE(LongestLine(ToTable(report, columns)), static_cast<std::size_t>(columns));
  }
  EXPECT_LE(LongestLine(ToTable(report, 0)), 24U);
  EXPECT_LE(LongestLine(ToTable(report, -5)), 24U);
}

TEST(Report, TheTableAlignsItsValues) {
  const std::string table = ToTable(Passed(), 80);
  EXPECT_THAT(table, HasSubstr("PASSED  intersection_yield: expectations_met\n"));
  EXPECT_THAT(table, HasSubstr("\ncontacts     0\n"));
  EXPECT_THAT(table, HasSubstr("\nclosest      0.625 m shell to shell\n"));
  EXPECT_THAT(table, HasSubstr("\narrived      1, 2\n"));
  EXPECT_THAT(table, HasSubstr("\nreaction     p50 50.5 ms, p99 51.0 ms, max 52.0 ms\n"));
  EXPECT_THAT(table, EndsWith("-\n"));
}

TEST(Report, TheTableSaysWhatDoesNotExist) {
  const std::string table = ToTable(Report{}, 40);
  EXPECT_THAT(table, HasSubstr("NOT RUN"));
  EXPECT_THAT(table, HasSubstr("\nhalted       none\n"));
  EXPECT_THAT(table, HasSubstr("\nclosest      -\n"));
}

}  // namespace
}  // namespace giveway

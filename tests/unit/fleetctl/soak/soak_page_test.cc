#include "services/fleetctl/soak/soak_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "services/fleetctl/soak/soak_format.h"
#include "tests/unit/fleetctl/soak/soak_results.h"

namespace giveway::fleetctl {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> Names(const std::vector<SoakPlot>& plots) {
  std::vector<std::string> names;
  for (const SoakPlot& plot : plots) names.push_back(plot.name);
  return names;
}

TEST(SoakPage, HasAPictureOfEverythingThereIs) {
  EXPECT_THAT(Names(PlotsOf(SampleSoak(1))), ElementsAre("faults", "modes", "detection", "times",
                                                         "memory", "heap", "near_misses"));
  EXPECT_THAT(PlotsOf(SoakResult{}), IsEmpty());
}

TEST(SoakPage, WithoutPicturesItSaysSoAndHasItsTables) {
  const std::string html = ToHtml(SampleSoak(1), {});
  EXPECT_THAT(html, AllOf(HasSubstr("gnuplot"), HasSubstr("Figures against budgets"),
                          HasSubstr("Near misses"), HasSubstr("Growth of the processes"),
                          HasSubstr("Accounting of samples"), HasSubstr("beacons ceased"),
                          HasSubstr("fleetctl soak warehouse_loop --faults everything")));
  EXPECT_THAT(ToHtml(SoakResult{}, {}), HasSubstr("not_run"));
}

TEST(SoakPage, AFaultThatHadNothingToActOnIsNotMissing) {
  SoakResult result = SampleSoak(1);
  EXPECT_THAT(SummaryOf(result)[1].text, Not(HasSubstr("nothing to act on")));
  result.faults[0].observed = false;
  result.faults[0].observed_how = "it logged nothing meanwhile";
  EXPECT_THAT(SummaryOf(result)[1].text,
              HasSubstr("23 of 24 seen by their effect, 0 skipped, 1 had nothing to act on"));
  const std::string html = ToHtml(result, {});
  EXPECT_THAT(html, AllOf(HasSubstr("no: it logged nothing"), Not(HasSubstr(">NO"))));
  result.faults[0].observed_how.clear();
  EXPECT_THAT(ToHtml(result, {}), HasSubstr(">NO<"));
  EXPECT_THAT(SummaryOf(result)[1].text, Not(HasSubstr("nothing to act on")));
}

// After an interrupt they were shown as faults without an effect.
TEST(SoakPage, AFaultThatNeverStartedIsNotMissing) {
  SoakResult result = SampleSoak(1);
  result.faults[0].observed = false;
  result.faults[0].observed_how.clear();
  result.faults[0].observed_s.reset();
  EXPECT_THAT(SummaryOf(result)[1].text,
              HasSubstr("23 of 24 seen by their effect, 0 skipped, 1 not "
                        "started"));
  EXPECT_THAT(ToHtml(result, {}), AllOf(HasSubstr(">not started<"), Not(HasSubstr(">NO<"))));
  EXPECT_EQ(SummariesOf(result.faults)[1].missing, 0U);
}

TEST(SoakPage, SaysOfHowManyLivesNoGrowthWasJudged) {
  SoakResult result = SampleSoak(1);
  EXPECT_THAT(ToText(result), HasSubstr("no leak in 9 slopes\n"));
  for (std::size_t i = 0; i < 4; ++i) result.slopes[i].slope.spans_s = 90;
  result.lives_too_short = 4;
  EXPECT_THAT(ToText(result), HasSubstr("no leak in 5 slopes; 4 lives too short to judge"));
}

TEST(SoakPage, LeadsToThePagesOfItsBlackBox) {
  SoakResult result = SampleSoak(1);
  result.kept_rings = {{12, 3, 3, "recordings/black-box-1.html"},
                       {40, 3, 2, "javascript:alert(1)"}};
  const std::string html = ToHtml(result, {});
  EXPECT_THAT(html, HasSubstr("<a href=\"recordings/black-box-1.html\">"));
  EXPECT_THAT(html, Not(HasSubstr("href=\"javascript")));
}

TEST(SoakPage, PicturesTakeTheColourOfItsText) {
  const std::string html = ToHtml(
      SampleSoak(1), {{"faults", "Faults & more", "<?xml?><svg stroke='black' fill=\"black\"/>"}});
  EXPECT_THAT(html, AllOf(HasSubstr("<svg stroke='currentColor' fill=\"currentColor\"/>"),
                          HasSubstr("Faults &amp; more"), Not(HasSubstr("<?xml"))));
}

TEST(SoakPage, NothingOfAResultIsMarkup) {
  const std::string evil = "<script>alert('x')</script>\" & \xff";
  SoakResult result = SampleSoak(1);
  result.scenario = result.command = result.qos_set = result.versions.kernel = evil;
  result.reasons = {evil};
  result.skipped_faults = {evil};
  result.faults[0].kind = result.faults[0].target = result.faults[0].observed_how = evil;
  result.faults[0].rule = evil;
  result.violations = {{1, VehicleId{1}, kNoVehicle, evil, evil, evil}};
  result.histograms[0].name = evil;
  result.slopes[0].process = evil;
  result.accounting[0].writer = result.accounting[0].topic = evil;
  result.modes[0].mode = evil;
  EXPECT_THAT(ToHtml(result, {}), Not(HasSubstr("<script")));
  for (const SoakPlot& plot : PlotsOf(result)) {
    EXPECT_THAT(plot.program, AllOf(Not(HasSubstr("<script")), Not(HasSubstr("alert('"))))
        << plot.name;
  }
}

// What the browser would fetch: nothing. The names of SVG's own schemas are not fetched.
TEST(SoakPage, LinksNowhere) {
  const std::string html = ToHtml(SampleSoak(1), {});
  EXPECT_THAT(html, AllOf(Not(HasSubstr("http")), Not(HasSubstr("<link")), Not(HasSubstr("src=")),
                          Not(HasSubstr("@import")), Not(HasSubstr("url("))));
}

TEST(SoakPage, ShowsWhatMattersOfTooMuch) {
  SoakResult result = SampleSoak(1);
  result.violations.assign(5000, {1, VehicleId{1}, kNoVehicle, "contact", "again", ""});
  result.violations_counted = 70'000;
  const std::string html = ToHtml(result, {});
  EXPECT_LT(html.size(), 200'000U);
  EXPECT_THAT(html, HasSubstr("69800 more are in report.json"));
}

TEST(SoakSummary, NoLineIsLongerThanATerminal) {
  SoakResult result = SampleSoak(1);
  result.verdict = SoakVerdict::kFailed;
  result.reasons = {std::string(300, 'x'), "vehicle-3 private_bytes leaks 3.6 MB an hour"};
  result.violations = {{12.5, VehicleId{3}, VehicleId{4}, "contact", "touched", "stop#1"}};
  result.violations_counted = 12;
  const std::string text = ToText(result);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 78U) << line;
  EXPECT_THAT(text, AllOf(HasSubstr("FAILED"), HasSubstr("after stop#1"), HasSubstr("and 11 more"),
                          HasSubstr("beacon_age"), HasSubstr("most 200.0 ms: kept")));
}

TEST(SoakSummary, SaysHowManyValuesAreMissing) {
  SoakResult result = SampleSoak(1);
  EXPECT_THAT(ToText(result), Not(HasSubstr("values lost")));
  result.timing_values_lost = 41;
  EXPECT_THAT(ToText(result), HasSubstr("values lost       41 of the figures"));
  EXPECT_THAT(ToHtml(result, {}), HasSubstr("41 of the figures"));
}

TEST(SoakSummary, FaultsAreSummedByKind) {
  SoakResult result = SampleSoak(1);
  result.faults[0].noticed_after_s = 0.6;  // later than promised
  result.faults[2].observed = false;
  const std::vector<FaultSummary> summaries = SummariesOf(result.faults);
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_EQ(summaries[0].kind, "kill");
  EXPECT_EQ(summaries[1].kind, "pause");
  EXPECT_EQ(summaries[1].planned, 12U);
  EXPECT_EQ(summaries[1].observed, 11U);
  EXPECT_EQ(summaries[1].late, 1U);
  EXPECT_DOUBLE_EQ(*GreatestOf(summaries[1].noticed_s), 0.6);
}

TEST(SoakBudgets, AreHeldAgainstTheQuantile) {
  SoakHistogram measured{.name = "reaction", .budgets = {{0.5, 100}, {1, 200}}};
  EXPECT_TRUE(WithinBudgets(measured));  // nothing measured
  measured.histogram.Add(50, 10);
  measured.histogram.Add(200, 1);
  EXPECT_TRUE(WithinBudgets(measured));
  measured.histogram.Add(201, 1);
  EXPECT_FALSE(WithinBudgets(measured));
  EXPECT_THAT(FormatBudgets(measured)[1], HasSubstr("EXCEEDED"));
}

TEST(SoakVerdicts, AreExitCodes) {
  EXPECT_EQ(ExitCode(SoakVerdict::kPassed), 0);
  EXPECT_EQ(ExitCode(SoakVerdict::kFailed), 1);
  EXPECT_EQ(ExitCode(SoakVerdict::kInterrupted), 1);
  EXPECT_EQ(ExitCode(SoakVerdict::kNotRun), 2);
}

}  // namespace
}  // namespace giveway::fleetctl

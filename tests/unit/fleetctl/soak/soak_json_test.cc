#include "services/fleetctl/soak/soak_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/fleetctl/soak/soak_results.h"

namespace giveway::fleetctl {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

TEST(SoakReportJson, ComesBackAsItWas) {
  SoakResult result = SampleSoak(1);
  result.verdict = SoakVerdict::kFailed;
  result.reasons = {"vehicle-3 leaks", "2 contacts"};
  result.skipped_faults = {"clock_step: faketime is not installed"};
  result.skipped_counted = 12;
  result.violations = {{12.5, VehicleId{3}, VehicleId{4}, "contact", "touched", "stop#1"}};
  result.violations_counted = 7;
  result.budget_spent_by_block = {0, 3};
  Random random(1);
  result.slopes.push_back(SampleSlope("leaking", &random, 3e3));
  MarkLeaks(&result.slopes, 0);
  const std::string json = ToJson(result);
  const ReadSoak read = SoakFromJson(json);
  ASSERT_EQ(read.complaint, "");
  EXPECT_EQ(ToJson(read.result), json);
  EXPECT_EQ(read.result.verdict, SoakVerdict::kFailed);
  EXPECT_EQ(read.result.skipped_counted, 12U);
  EXPECT_EQ(read.result.faults[3].noticed_after_s.has_value(), true);
  EXPECT_EQ(read.result.histograms[1].histogram, result.histograms[1].histogram);
  EXPECT_EQ(read.result.histograms[1].blocks, result.histograms[1].blocks);
  EXPECT_EQ(read.result.near_misses_by_block, result.near_misses_by_block);
  EXPECT_EQ(read.result.budget_spent_by_block, (std::vector<std::uint64_t>{0, 3}));
  EXPECT_EQ(read.result.block_s, 9);
  EXPECT_EQ(read.result.violations[0].vehicle, VehicleId{3});
  EXPECT_EQ(read.result.narrowest_margin->vehicle, VehicleId{3});
  EXPECT_EQ(read.result.accounting[0].Difference(), 0);
  EXPECT_TRUE(read.result.slopes.back().leak);
}

TEST(SoakReportJson, OfAnOlderReportEachSkippedFaultHasALine) {
  SoakResult result = SampleSoak(1);
  result.skipped_faults = {"a#0: no", "a#1: no"};
  const std::string json = Replaced(ToJson(result), ",\"skipped_counted\":0", "");
  ASSERT_EQ(SoakFromJson(json).complaint, "");
  EXPECT_EQ(SoakFromJson(json).result.skipped_counted, 2U);
}

TEST(SoakReportJson, ListsAreCutWhereTheyGetTooLong) {
  SoakResult result = SampleSoak(1);
  result.skipped_faults.assign(kMostListed + 1, "a#0: no");
  EXPECT_EQ(SoakFromJson(ToJson(result)).result.skipped_faults.size(), kMostListed);
}

TEST(SoakReportJson, NamesEachKindOfResource) {
  SoakResult result = SampleSoak(1);
  for (std::size_t i = 0; i < kResourceKinds; ++i) {
    result.slopes[i].kind = static_cast<ResourceKind>(i);
  }
  const ReadSoak read = SoakFromJson(ToJson(result));
  ASSERT_EQ(read.complaint, "");
  for (std::size_t i = 0; i < kResourceKinds; ++i) {
    EXPECT_EQ(read.result.slopes[i].kind, static_cast<ResourceKind>(i));
  }
}

TEST(SoakReportJson, IsOneLineWithoutWordsJsonDoesNotHave) {
  SoakResult result = SampleSoak(1);
  result.pauses.share = std::nan("");
  result.faults[0].noticed_after_s = INFINITY;
  result.scenario = "bad\xff\nname";
  const std::string json = ToJson(result);
  EXPECT_THAT(json, AllOf(Not(HasSubstr("\n")), Not(HasSubstr("NaN")), Not(HasSubstr("Infinity"))));
  EXPECT_EQ(SoakFromJson(json).complaint, "");
  EXPECT_FALSE(SoakFromJson(json).result.faults[0].noticed_after_s);
}

TEST(SoakReportJson, AnEmptyResultIsPrintedWhole) {
  const std::string json = ToJson(SoakResult{});
  EXPECT_THAT(json, AllOf(HasSubstr("\"verdict\":\"not_run\""), HasSubstr("\"violations\":[]"),
                          Not(HasSubstr("narrowest_margin")), HasSubstr("\"seed\":0")));
  EXPECT_EQ(SoakFromJson(json).complaint, "");
}

TEST(SoakReportJson, WhatDoesNotFitIsSaidAllAtOnce) {
  std::string json = ToJson(SampleSoak(1));
  json = Replaced(json, "\"format\":1", "\"format\":2");
  json = Replaced(json, "\"unit\":\"ns\"", "\"unit\":\"feet\"");
  json = Replaced(json, "\"kind\":\"private_bytes\"", "\"kind\":\"lint\"");
  json = Replaced(json, "\"sent\":3600", "\"sent\":-1");
  EXPECT_THAT(SoakFromJson(json).complaint,
              AllOf(HasSubstr("format is 2, must be 1"), HasSubstr("histograms[0].unit"),
                    HasSubstr("slopes[0].kind"), HasSubstr("accounting[0].sent")));
}

TEST(SoakReportJson, BlocksThatDoNotFitAreRefused) {
  SoakResult result = SampleSoak(1);
  result.near_misses_by_block.resize(21);
  std::string json = Replaced(ToJson(result), "\"block_p99\":[", "\"block_p99\":[1,");
  EXPECT_THAT(SoakFromJson(json).complaint,
              AllOf(HasSubstr("histograms[0].block_p99"), HasSubstr("near_misses_by_block")));
}

TEST(SoakReportJson, OtherFilesAreNoReports) {
  EXPECT_THAT(SoakFromJson("{\"scenario\":\"x\",\"contacts\":1}").complaint, HasSubstr("contacts"));
  EXPECT_NE(SoakFromJson("").complaint, "");
  EXPECT_NE(SoakFromJson("[]").complaint, "");
  EXPECT_NE(SoakFromJson("{}").complaint, "");
  EXPECT_THAT(ReadSoakReport("/nowhere/at/all").complaint, HasSubstr("/nowhere/at/all"));
}

TEST(SoakReportJson, HistogramsThatDoNotAddUpAreRefused) {
  const std::string json = ToJson(SampleSoak(1));
  const std::size_t at = json.find("\"lowest\":[") + 10;
  const std::string swapped = json.substr(0, at) + "99999999999," + json.substr(at);
  EXPECT_THAT(SoakFromJson(swapped).complaint, HasSubstr("histograms[0].count"));
}

}  // namespace
}  // namespace giveway::fleetctl

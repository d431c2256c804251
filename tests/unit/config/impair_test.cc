// Impairments in scenarios and in --impair, and what either refuses.
#include "services/config/impair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/config/writing/scenario_write.h"
#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Every number differs from its default.
ImpairmentRule Everything() {
  ImpairmentRule rule;
  rule.from = ImpairedSender::kOneVehicle;
  rule.from_vehicle = VehicleId{1};
  rule.to_vehicle = VehicleId{2};
  rule.loss = 0.125;
  rule.burst = 0.25;
  rule.burst_length = 8;
  rule.burst_loss = 0.75;
  rule.delay_s = 0.02;
  rule.jitter_s = 0.005;
  rule.reorder = 0.0625;
  rule.reorder_by_s = 0.06;
  rule.duplicate = 0.03125;
  rule.corrupt = 0.5;
  rule.rate_bytes_s = 64000;
  rule.rate_burst_bytes = 4096;
  rule.blackouts = {{5, 7.5}, {9, 10}};
  rule.from_s = 4;
  rule.to_s = 60.5;
  return rule;
}

const std::string kEverythingAsText =
    "from=1,to=2,loss=0.125,burst=0.25,burst_length=8,burst_loss=0.75,delay=20ms,jitter=5000us,"
    "reorder=0.0625,reorder_by=0.06s,duplicate=0.03125,corrupt=0.5,rate=64000,rate_burst=4096,"
    "blackout=5s..7500ms,blackout=9s..10s,during=4s..60500ms,seed=7";

const std::string kEverythingInAScenario =
    "impair { from_vehicle: 1 to_vehicle: 2 loss: 0.125 burst: 0.25 burst_length: 8 "
    "burst_loss: 0.75 delay_ms: 20 jitter_ms: 5 reorder: 0.0625 reorder_by_ms: 60 "
    "duplicate: 0.03125 corrupt: 0.5 rate_bytes_s: 64000 rate_burst_bytes: 4096 "
    "blackout { from_s: 5 to_s: 7.5 } blackout { from_s: 9 to_s: 10 } from_s: 4 to_s: 60.5 } "
    "impair_seed: 7";

TEST(ImpairmentText, SaysEverythingThereIs) {
  const ParsedImpairment parsed = ParseImpairment(kEverythingAsText);
  EXPECT_THAT(parsed.problems, IsEmpty());
  EXPECT_EQ(parsed.impairment, (Impairment{7, {Everything()}}));
  for (const ImpairField& field : ImpairFields()) {
    EXPECT_THAT(kEverythingAsText, HasSubstr(std::string(field.key) + "="));
    EXPECT_NE(Everything().*field.member, ImpairmentRule{}.*field.member) << field.key;
  }
}

TEST(ImpairmentText, AShareMayBeGivenInPercent) {
  const auto percent = ParseImpairment("loss=10%,burst=2.5%,corrupt=100%");
  EXPECT_THAT(percent.problems, IsEmpty());
  EXPECT_EQ(percent.impairment, ParseImpairment("loss=0.1,burst=0.025,corrupt=1").impairment);
  EXPECT_EQ(ParseImpairment("loss=101%").problems.size(), 1U);
  EXPECT_EQ(ParseImpairment("loss=%").problems.size(), 1U);
  EXPECT_EQ(ParseImpairment("burst=0.1,burst_length=8%").problems.size(), 1U);
  EXPECT_EQ(ParseImpairment("delay=5%").problems.size(), 1U);
}

TEST(ImpairmentText, HasRulesInTurnAndOneSeed) {
  const Impairment impairment =
      ParseImpairment("from=vehicles,loss=0.1;from=world;from=anyone,to=3,seed=0").impairment;
  ASSERT_THAT(impairment.rules, SizeIs(3));
  EXPECT_EQ(impairment.rules[0].from, ImpairedSender::kVehicles);
  EXPECT_EQ(impairment.rules[0].loss, 0.1);
  EXPECT_EQ(impairment.rules[1].from, ImpairedSender::kWorld);
  EXPECT_EQ(impairment.rules[2].from, ImpairedSender::kAnyone);
  EXPECT_EQ(impairment.rules[2].to_vehicle, VehicleId{3});
  EXPECT_EQ(impairment.seed, 0U);
  EXPECT_EQ(ParseImpairment("loss=0.1").impairment.seed, std::nullopt);
}

TEST(ImpairmentText, NoneIsNone) {
  EXPECT_EQ(ParseImpairment("none").impairment, Impairment{});
  EXPECT_THAT(ParseImpairment("none").problems, IsEmpty());
}

struct Refused {
  const char* text;
  const char* message;
};

class RefusedImpairment : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedImpairment, IsOneProblemWithItsRemedy) {
  const auto problems = ParseImpairment(GetParam().text).problems;
  ASSERT_THAT(problems, SizeIs(1)) << GetParam().text;
  EXPECT_THAT(problems[0].message, HasSubstr(GetParam().message));
  EXPECT_FALSE(problems[0].remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedImpairment,
    ::testing::Values(Refused{"", "\"\" is no key=value"}, Refused{"loss", "is no key=value"},
                      Refused{"loss=0.1,", "\"\" is no key=value"},
                      Refused{"lose=0.1", "lose = 0.1: is no part of an impairment"},
                      Refused{"loss=1.5", "loss = 1.5: must be a number between 0 and 1"},
                      Refused{"loss=-0.1", "between 0 and 1"}, Refused{"loss=nan", "must be"},
                      Refused{"loss=101%", "loss = 101%"}, Refused{"loss=0.1x", "loss = 0.1x"},
                      Refused{"loss=0.1,loss=0.2", "loss = 0.2: is given twice"},
                      Refused{"burst=0.95", "between 0 and 0.9"},
                      Refused{"burst=0.6,burst_length=1", "at most 0.5 can be bad"},
                      Refused{"burst_length=0", "between 1 and 10000 packets"},
                      Refused{"delay=20", "must be a time with its unit"},
                      Refused{"delay=11s", "between 0 and 10000 ms"},
                      Refused{"delay=ms", "must be a time"}, Refused{"delay=-1ms", "between 0"},
                      Refused{"jitter=5ms", "a jitter of 5 ms is more than the delay of 0 ms"},
                      Refused{"reorder=0.1,reorder_by=0ms", "above 0 and at most 10000 ms"},
                      Refused{"rate=-1", "bytes/s"}, Refused{"rate_burst=0", "bytes"},
                      Refused{"from=0", "names no sender"}, Refused{"from=fleet", "no sender"},
                      Refused{"from=4294967296", "no sender"}, Refused{"to=world", "no vehicle"},
                      Refused{"blackout=5s", "is no span of time"},
                      Refused{"blackout=5..7", "is no span of time"},
                      Refused{"blackout=7s..5s", "must begin before it ends"},
                      Refused{"blackout=5s..5s", "must begin before it ends"},
                      Refused{"blackout=-1s..5s", "between 0 and 2592000 s"},
                      Refused{"during=5s", "is no span of time"},
                      Refused{"during=..", "is no span of time"},
                      Refused{"during=5s..7", "is no span of time"},
                      Refused{"during=7s..5s", "must begin before it ends"},
                      Refused{"during=..0s", "must begin before it ends"},
                      Refused{"during=1s..2s,during=4s..5s", "is given twice"},
                      Refused{"during=2592001s..", "between 0 and 2592000 s"},
                      Refused{"seed=-1", "seed = -1: must be a whole number"},
                      Refused{"seed=1;seed=2", "is the second seed"}));

TEST(ImpairmentText, EveryProblemIsToldAtOnce) {
  EXPECT_THAT(ParseImpairment("loss=2,delay=5,x=1;from=0").problems, SizeIs(4));
}

TEST(ImpairmentText, HasAtMostSoManyRulesAndBlackouts) {
  std::string rules = "loss=0.1";
  std::string blackouts = "blackout=1s..2s";
  for (int i = 1; i < 1024; ++i) {
    rules += ";loss=0.1";
    blackouts += ",blackout=1s..2s";
  }
  EXPECT_THAT(ParseImpairment(rules).problems, IsEmpty());
  EXPECT_THAT(ParseImpairment(rules + ";loss=0.1").problems, SizeIs(1));
  EXPECT_THAT(ParseImpairment(blackouts).problems, IsEmpty());
  EXPECT_THAT(ParseImpairment(blackouts + ",blackout=1s..2s").problems, SizeIs(1));
}

TEST(ImpairmentText, MayBeOpenAtOneEnd) {
  const auto rules = ParseImpairment("loss=1,during=..5s;loss=1,during=7s..").impairment.rules;
  ASSERT_THAT(rules, SizeIs(2));
  EXPECT_EQ(rules[0].from_s, std::nullopt);
  EXPECT_EQ(rules[0].to_s, 5);
  EXPECT_EQ(rules[1].from_s, 7);
  EXPECT_EQ(rules[1].to_s, std::nullopt);
}

TEST(ImpairmentText, MayStandInAFileOfManyMoreRules) {
  const TempFolder folder;
  std::string rules = "loss=0.1";
  for (int i = 0; i < 5000; ++i) rules += ";loss=0.1,during=1s..2s";
  EXPECT_THAT(ParseImpairment(rules).problems, SizeIs(1));
  const ParsedImpairment parsed = ParseImpairment("@" + folder.Write("rules", rules + "\n"));
  EXPECT_THAT(parsed.problems, IsEmpty());
  EXPECT_THAT(parsed.impairment.rules, SizeIs(5001));
  const auto absent = ParseImpairment("@" + folder.Path() + "/none").problems;
  ASSERT_THAT(absent, SizeIs(1));
  EXPECT_THAT(absent[0].message, HasSubstr("/none: does not exist"));
  EXPECT_THAT(ParseImpairment("@" + folder.Write("bad", "loss=2")).problems, SizeIs(1));
}

TEST(ImpairmentText, IsReadBackAsItWasWritten) {
  ImpairmentRule open;
  open.from = ImpairedSender::kWorld;
  open.delay_s = 0.1 + 0.2;
  open.to_s = 1.0 / 3;
  ImpairmentRule to_one;
  to_one.to_vehicle = VehicleId{3};
  const Impairment impairment{9, {Everything(), open, to_one, {}}};
  const ParsedImpairment parsed = ParseImpairment(ImpairmentText(impairment));
  EXPECT_THAT(parsed.problems, IsEmpty()) << ImpairmentText(impairment);
  EXPECT_EQ(parsed.impairment, impairment);
  EXPECT_EQ(ImpairmentText({}), "none");
  EXPECT_EQ(ImpairmentText(ParseImpairment("from=vehicles,loss=0.3,during=60s..80s").impairment),
            "from=vehicles,loss=0.3,during=60s..80s");
}

TEST(ImpairmentInAFile, SaysTheSameAsTheFlag) {
  const Scenario scenario = Load(kGoodScenario + kEverythingInAScenario);
  EXPECT_EQ(scenario.impairment, ParseImpairment(kEverythingAsText).impairment);
  EXPECT_EQ(Load(kGoodScenario).impairment, Impairment{});
  EXPECT_EQ(Load(kGoodScenario + "impair {}").impairment, (Impairment{{}, {{}}}));
}

TEST(ImpairmentInAFile, NamesSendersByKind) {
  const auto rules =
      Load(kGoodScenario + "impair { from: vehicles } impair { from: world }").impairment.rules;
  ASSERT_THAT(rules, SizeIs(2));
  EXPECT_EQ(rules[0].from, ImpairedSender::kVehicles);
  EXPECT_EQ(rules[1].from, ImpairedSender::kWorld);
}

TEST(ImpairmentInAFile, IsRefusedFieldByField) {
  const auto refused = [](const std::string& rule, const char* field, const char* message) {
    EXPECT_THAT(ProblemsOf(kGoodScenario + "impair { " + rule + " }"),
                ElementsAre(Is(17, std::string("impair[0].") + field, message)))
        << rule;
  };
  refused("loss: 1.01", "loss", "between 0 and 1");
  refused("loss: nan", "loss", "finite");
  refused("burst: 0.8 burst_length: 2", "burst", "at most 0.667 can be bad");
  refused("delay_ms: 10001", "delay_ms", "between 0 and 10000 ms");
  refused("delay_ms: 5 jitter_ms: 6", "jitter_ms", "a jitter of 6 ms");
  refused("reorder_by_ms: 0", "reorder_by_ms", "above 0");
  refused("rate_bytes_s: -1", "rate_bytes_s", "bytes/s");
  refused("from_vehicle: 3", "from_vehicle", "no vehicle has this id");
  refused("to_vehicle: 0", "to_vehicle", "between 1");
  refused("from: world from_vehicle: 1", "from", "beside from_vehicle");
  refused("blackout { from_s: 5 to_s: 5 }", "blackout[0].to_s", "ends before it begins");
  refused("blackout { from_s: 5 }", "blackout[0].to_s", "missing");
  refused("from_s: 5 to_s: 5", "to_s", "ends before it begins");
  refused("to_s: 0", "to_s", "ends before it begins");
  refused("from_s: -1", "from_s", "between 0 and 2592000 s");
}

TEST(ImpairmentInAFile, ASeedWithoutAnImpairmentIsRefused) {
  EXPECT_THAT(ProblemsOf(kGoodScenario + "impair_seed: 3"),
              ElementsAre(Is(17, "impair_seed", "nothing is impaired")));
}

TEST(ImpairmentInAFile, ReadsBackAsItWasWritten) {
  const std::string text = kGoodScenario + kEverythingInAScenario +
                           " impair { from: vehicles to_vehicle: 1 } impair { loss: 0.3 }";
  const Scenario scenario = Load(text);
  ASSERT_THAT(scenario.impairment.rules, SizeIs(3));
  EXPECT_EQ(Load(WriteScenario(scenario, "")).impairment, scenario.impairment);
}

}  // namespace
}  // namespace giveway

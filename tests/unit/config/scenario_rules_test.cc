// One test a rule of scenario files. Each corrupts one good text; the lines are those of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "services/runtime/utf8.h"
#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ScenarioRules, TheGoodTextHasNoProblem) { EXPECT_THAT(ProblemsOf(kGoodScenario), IsEmpty()); }

TEST(ScenarioRules, AnUnknownFieldIsRefusedWithTheFieldsThereAre) {
  const auto problems = ProblemsOf(Edited("cruise_m_s: 0.4", "cruise_m_s: 0.4 cruse: 3"));
  ASSERT_THAT(problems, ElementsAre(Is(6, "cruse", "is no field of Vehicle")));
  EXPECT_THAT(problems[0].remedy, HasSubstr("cruise_m_s"));
}

TEST(ScenarioRules, AnUnknownMessageIsRefusedOnce) {
  EXPECT_THAT(ProblemsOf(Edited("wall {", "waal { a: 1 } wall {")),
              ElementsAre(Is(14, "waal", "is no field of Scenario")));
}

TEST(ScenarioRules, AnErrorOfSyntaxIsToldWithTheUnknownFieldsBeforeIt) {
  EXPECT_THAT(ProblemsOf(Edited("wall { from", "abc: 1 wall { from from")),
              ElementsAre(Is(14, "abc", "is no field"), Is(14, "", "column")));
}

// The parser names a misplaced character by its first byte alone.
TEST(ScenarioRules, WhatTheParserSaysIsTextWhateverItFound) {
  const auto problems = ProblemsOf(Edited("cruise_m_s: 0.4", "\xc3\xa9 cruise_m_s: 0.4"));
  ASSERT_FALSE(problems.empty());
  EXPECT_TRUE(IsText(Format(problems))) << Format(problems);
}

TEST(ScenarioRules, AFieldWrittenTwiceIsRefused) {
  EXPECT_THAT(ProblemsOf(Edited("cruise_m_s: 0.4", "cruise_m_s: 0.4 cruise_m_s: 0.5")),
              ElementsAre(Is(6, "", "specified multiple times")));
}

TEST(ScenarioRules, NumbersThatAreNotFiniteAreRefusedAsTheyWereWritten) {
  for (const char* value : {"nan", "inf", "-inf", "1e400", "-1e400"}) {
    const auto problems = ProblemsOf(Edited("0.4", value));
    ASSERT_THAT(problems, ElementsAre(Is(6, "vehicle[0].cruise_m_s", "not a finite number")));
    EXPECT_EQ(problems[0].value, value);
  }
}

TEST(ScenarioRules, TheNameIsRequiredAndClean) {
  EXPECT_THAT(ProblemsOf(Edited("name: \"two\"", "")), ElementsAre(Is(1, "name", "missing")));
  for (const char* name : {"\"\"", "\"Two\"", "\"a/b\"", "\"a\\nb\"", "\"\\377\""}) {
    EXPECT_THAT(ProblemsOf(Edited("\"two\"", name)), ElementsAre(Is(1, "name", "a-z 0-9")));
  }
}

TEST(ScenarioRules, TheAreaIsClean) {
  EXPECT_THAT(ProblemsOf(kGoodScenario + "area: \"*\""), ElementsAre(Is(17, "area", "a-z 0-9")));
  EXPECT_EQ(Load(kGoodScenario + "area: \"hall-2_b\"").area, "hall-2_b");
}

TEST(ScenarioRules, ADescriptionHoldsNoControlCharacters) {
  EXPECT_THAT(ProblemsOf(kGoodScenario + "description: \"\\033[2J\""),
              ElementsAre(Is(17, "description", "control")));
}

TEST(ScenarioRules, AVehicleNeedsIdStartAndCruise) {
  EXPECT_THAT(ProblemsOf(kGoodScenario + "vehicle {\n}"),
              ElementsAre(Is(17, "vehicle[2].id", "missing"), Is(17, "vehicle[2].start", "missing"),
                          Is(17, "vehicle[2].cruise_m_s", "missing")));
}

TEST(ScenarioRules, AStartNeedsAllItsNumbers) {
  EXPECT_THAT(ProblemsOf(Edited("x_m: 0 y_m: -3 heading_deg: 90", "")),
              ElementsAre(Is(11, "vehicle[1].start.x_m", "missing"),
                          Is(11, "vehicle[1].start.y_m", "missing"),
                          Is(11, "vehicle[1].start.heading_deg", "missing")));
}

TEST(ScenarioRules, AScenarioNeedsVehiclesAndAnExpectation) {
  EXPECT_THAT(ProblemsOf("name: \"a\""),
              ElementsAre(Is(1, "vehicle", "missing"), Is(1, "expect", "missing")));
}

TEST(ScenarioRules, ANonsenseHeadingIsRefused) {
  EXPECT_THAT(ProblemsOf(Edited("heading_deg: 90", "heading_deg: 361")),
              ElementsAre(Is(11, "vehicle[1].start.heading_deg", "between -360 and 360 degrees")));
  EXPECT_THAT(ProblemsOf(Edited("heading_deg: 90", "heading_deg: nan")),
              ElementsAre(Is(11, "vehicle[1].start.heading_deg", "finite")));
}

TEST(ScenarioRules, IdZeroIsRefused) {
  EXPECT_THAT(ProblemsOf(Edited("id: 1", "id: 0") + "fault { kill: 0 at_s: 1 }"),
              ElementsAre(Is(4, "vehicle[0].id", "between 1 and"),
                          Is(16, "expect.arrived[0]", "no vehicle"),
                          Is(17, "fault[1].kill", "between 1 and")));
}

TEST(ScenarioRules, IdsAreUnique) {
  EXPECT_THAT(ProblemsOf(Edited("id: 1", "id: 2") + "#"),
              ElementsAre(Is(10, "vehicle[1].id", "another vehicle"),
                          Is(16, "expect.arrived[0]", "no vehicle")));
}

TEST(ScenarioRules, ANegativeIdIsAnErrorOfSyntax) {
  EXPECT_THAT(ProblemsOf(Edited("id: 1", "id: -1")), ElementsAre(Is(4, "", "column")));
}

TEST(ScenarioRules, StartDiscsMustNotOverlap) {
  const auto problems = ProblemsOf(Edited("x_m: 0 y_m: -3", "x_m: -4 y_m: 0.49"));
  ASSERT_THAT(problems, ElementsAre(Is(11, "vehicle[1].start", "vehicle 2 overlaps vehicle 1")));
  EXPECT_THAT(ProblemsOf(Edited("x_m: 0 y_m: -3", "x_m: -4 y_m: 0.51")), IsEmpty());
}

TEST(ScenarioRules, AStartDiscMustNotTouchAWall) {
  EXPECT_THAT(ProblemsOf(Edited("x_m: 0 y_m: -3", "x_m: 0 y_m: 2.8")),
              ElementsAre(Is(11, "vehicle[1].start", "overlaps wall[0]")));
  EXPECT_THAT(ProblemsOf(Edited("x_m: 0 y_m: -3", "x_m: 5.2 y_m: 3")),
              ElementsAre(Is(11, "vehicle[1].start", "overlaps wall[0]")));
  EXPECT_THAT(ProblemsOf(Edited("x_m: 0 y_m: -3", "x_m: 5.3 y_m: 3")), IsEmpty());
}

// Its corners reach 0.84 m, and no sensor hears what they come to.
TEST(ScenarioRules, ABoxHasRoomToTurnWhereItStarts) {
  const auto start = [](const std::string& heading_deg, const std::string& place) {
    return ProblemsOf(Edited("heading_deg: 0 }\n  cruise_m_s: 0.4",
                             "heading_deg: " + heading_deg +
                                 " }\n  cruise_m_s: 0.4 "
                                 "profile { box { half_length_m: 0.8 half_width_m: 0.25 } }") +
                      place);
  };
  const std::string wall = "wall { from { x_m: -9 y_m: 0.5 } to { x_m: -3 y_m: 0.5 } }";
  const auto problems = start("180", wall);
  ASSERT_THAT(problems, ElementsAre(Is(5, "vehicle[0].start", "0.838 m from its centre")));
  EXPECT_THAT(problems[0].message, HasSubstr("reach wall[1]"));
  EXPECT_THAT(problems[0].remedy, HasSubstr("start it 0.839 m away"));
  EXPECT_THAT(start("180", "obstacle { disc_radius_m: 0.2 start { x_m: -4 y_m: -0.7 } }"),
              ElementsAre(Is(5, "vehicle[0].start", "reach obstacle[0]")));
  EXPECT_THAT(start("15", wall), IsEmpty()) << "its goal is nearly straight ahead";
  EXPECT_THAT(start("180", "wall { from { x_m: -9 y_m: 0.84 } to { x_m: -3 y_m: 0.84 } }"),
              IsEmpty());
  EXPECT_THAT(start("180", wall + "behaviour: lecture_avoid"), IsEmpty())
      << "it drives by what it hears alone";
}

TEST(ScenarioRules, AStartMustNotLieInsideItsGoal) {
  EXPECT_THAT(ProblemsOf(Edited("goal { x_m: 2 y_m: 0", "goal { x_m: -4 y_m: 0.05")),
              ElementsAre(Is(5, "vehicle[0].start", "inside the vehicle's own goal")));
}

TEST(ScenarioRules, AGoalNeedsAPointAndAPositiveRadius) {
  EXPECT_THAT(ProblemsOf(Edited("goal { x_m: 2 y_m: 0", "goal { x_m: 2")),
              ElementsAre(Is(7, "vehicle[0].goal.y_m", "missing")));
  EXPECT_THAT(ProblemsOf(Edited("2 y_m: 0 }", "2 y_m: 0 radius_m: -0.1 }")),
              ElementsAre(Is(7, "vehicle[0].goal.radius_m", "above 0")));
}

TEST(ScenarioRules, AGoalThatOneTickJumpsOverIsRefused) {
  EXPECT_THAT(ProblemsOf(Edited("2 y_m: 0 }", "2 y_m: 0 radius_m: 0.019 }")),
              ElementsAre(Is(7, "vehicle[0].goal.radius_m", "jump over its goal")));
  EXPECT_THAT(ProblemsOf(Edited("2 y_m: 0 }", "2 y_m: 0 radius_m: 0.021 }")), IsEmpty());
}

TEST(ScenarioRules, CruiseIsAboveZeroAndWithinTheProfile) {
  for (const char* cruise : {"0", "-0.4", "1.01"}) {
    EXPECT_THAT(ProblemsOf(Edited("0.4", cruise)),
                ElementsAre(Is(6, "vehicle[0].cruise_m_s", "above 0 and at most 1 m/s")));
  }
  EXPECT_THAT(ProblemsOf(Edited("cruise_m_s: 0.4", "cruise_m_s: 0.4 profile{max_speed_m_s: 0.3}")),
              ElementsAre(Is(6, "vehicle[0].cruise_m_s", "at most 0.3 m/s")));
}

TEST(ScenarioRules, AWallNeedsTwoPointsThatDiffer) {
  EXPECT_THAT(ProblemsOf(kGoodScenario + "wall { from { x_m: 1 y_m: 1 } }"),
              ElementsAre(Is(17, "wall[1].to", "missing")));
  EXPECT_THAT(ProblemsOf(kGoodScenario + "wall { from { x_m: 1 y_m: 1 } to { x_m: 1 y_m: 1 } }"),
              ElementsAre(Is(17, "wall[1].to", "no length")));
}

TEST(ScenarioRules, AFaultNeedsAKnownVehicleAndACondition) {
  EXPECT_THAT(ProblemsOf(Edited("kill: 2", "kill: 7")),
              ElementsAre(Is(15, "fault[0].kill", "no vehicle")));
  EXPECT_THAT(ProblemsOf(Edited("kill: 2 at_s: 4", "kill: 2")),
              ElementsAre(Is(15, "fault[0]", "no condition")));
  EXPECT_THAT(ProblemsOf(Edited("kill: 2 at_s: 4", "at_s: 4")),
              ElementsAre(Is(15, "fault[0]", "names none of kill, dark and silent")));
  EXPECT_THAT(ProblemsOf(Edited("at_s: 4", "at_s: -1")),
              ElementsAre(Is(15, "fault[0].at_s", "between 0 and")));
}

TEST(ScenarioRules, AFaultBeforeTheCrossingNeedsACrossing) {
  const std::string text = Edited("crossing { x_m: 0 y_m: 0 }", "");
  EXPECT_THAT(ProblemsOf(text + "fault { kill: 1 before_crossing_m: 1 }"),
              ElementsAre(Is(17, "fault[1].before_crossing_m", "no crossing")));
}

TEST(ScenarioRules, AnExpectationNamesKnownVehiclesOnce) {
  EXPECT_THAT(ProblemsOf(Edited("arrived: [1]", "arrived: [1, 9] halted: [2, 2]")),
              ElementsAre(Is(16, "expect.halted[1]", "names 2 twice"),
                          Is(16, "expect.arrived[1]", "no vehicle has the id 9")));
}

TEST(ScenarioRules, AVehicleWithoutGoalCannotBeExpectedToArrive) {
  EXPECT_THAT(ProblemsOf(Edited("arrived: [1]", "arrived: [1, 2]")),
              ElementsAre(Is(16, "expect.arrived", "vehicle 2 has no goal")));
}

TEST(ScenarioRules, BoundsOfAnExpectationAreNumbers) {
  EXPECT_THAT(ProblemsOf(Edited("arrived: [1]", "min_separation_m: -1 time_to_clear_s: nan")),
              ElementsAre(Is(16, "expect.min_separation_m", "between 0"),
                          Is(16, "expect.time_to_clear_s", "finite")));
}

TEST(ScenarioRules, TheEntryGateIsBelowTheExitGate) {
  EXPECT_THAT(ProblemsOf(kGoodScenario + "gate_enter_m: 1.2"),
              ElementsAre(Is(17, "gate_enter_m", "below the exit gate (1.2 m)")));
  EXPECT_THAT(ProblemsOf(kGoodScenario + "gate_exit_m: 0.9"),
              ElementsAre(Is(17, "gate_exit_m", "entry gate (1 m)")));
}

TEST(ScenarioRules, TheNearGateIsBelowTheFarGate) {
  EXPECT_THAT(ProblemsOf(Edited("id: 2", "id: 2 braitenberg { near_gate_m: 1 }")),
              ElementsAre(Is(10, "vehicle[1].braitenberg.near_gate_m", "below the far gate")));
}

TEST(ScenarioRules, WeightsComeInEightsForBothWheels) {
  EXPECT_THAT(ProblemsOf(Edited("id: 2", "id: 2 braitenberg { left: [1, 2] }")),
              ElementsAre(Is(10, "vehicle[1].braitenberg.left", "has 2 values"),
                          Is(10, "vehicle[1].braitenberg.right", "has 0 values")));
}

TEST(ScenarioRules, EveryWeightIsFinite) {
  const char* text = "id: 2 braitenberg { left: [0,0,0,nan,0,0,0,0] right: [0,0,0,0,0,0,0,101] }";
  EXPECT_THAT(ProblemsOf(Edited("id: 2", text)),
              ElementsAre(Is(10, "vehicle[1].braitenberg.left[3]", "finite"),
                          Is(10, "vehicle[1].braitenberg.right[7]", "between -100 and 100")));
}

TEST(ScenarioRules, ATickTheBeaconAgeLimitCannotGuardIsRefused) {
  EXPECT_THAT(ProblemsOf(kGoodScenario + "tick_period_ms: 67"),
              ElementsAre(Is(17, "tick_period_ms", "three ticks must fit")));
  EXPECT_THAT(ProblemsOf(kGoodScenario + "beacon_age_limit_ms: 149"),
              ElementsAre(Is(17, "beacon_age_limit_ms", "three ticks must fit")));
  EXPECT_THAT(ProblemsOf(kGoodScenario + "tick_period_ms: 66"), IsEmpty());
}

// No vehicle gives way to a vehicle whose beacons its peers reject.
TEST(ScenarioRules, AVehicleWhosePeersWouldNotBelieveItIsRefused) {
  EXPECT_THAT(ProblemsOf(Edited("cruise_m_s: 0.4", "cruise_m_s: 2 profile{max_speed_m_s: 2.4}")),
              IsEmpty());
  EXPECT_THAT(ProblemsOf(Edited("cruise_m_s: 0.4", "cruise_m_s: 3 profile{max_speed_m_s: 4}")),
              ElementsAre(Is(6, "vehicle[0].profile.max_speed_m_s", "at most 2.5"),
                          Is(6, "vehicle[0].cruise_m_s", "at most 2.5")));
  EXPECT_THAT(
      ProblemsOf(Edited("cruise_m_s: 0.4", "cruise_m_s: 0.4 profile{wheel_radius_m: 0.03}")),
      ElementsAre(Is(6, "vehicle[0].profile", "42.9 rad/s")));
}

struct OutOfRange {
  const char* field;
  const char* value;
};
std::string NameOf(const ::testing::TestParamInfo<OutOfRange>& info) {
  return std::string(info.param.field) + "_" + std::to_string(info.index);
}

class SettingsOutOfRange : public ::testing::TestWithParam<OutOfRange> {};

TEST_P(SettingsOutOfRange, AreRefused) {
  const auto [field, value] = GetParam();
  EXPECT_THAT(ProblemsOf(kGoodScenario + field + ": " + value),
              ::testing::Contains(Is(17, field, "must be")));
}

INSTANTIATE_TEST_SUITE_P(
    ScenarioRules, SettingsOutOfRange,
    ::testing::Values(OutOfRange{"tick_period_ms", "4"}, OutOfRange{"tick_period_ms", "nan"},
                      OutOfRange{"duration_s", "-1"}, OutOfRange{"duration_s", "86401"},
                      OutOfRange{"start_timeout_s", "0"}, OutOfRange{"remove_after_s", "-1"},
                      OutOfRange{"watchdog_ticks", "0"}, OutOfRange{"watchdog_ticks", "101"},
                      OutOfRange{"emission_radius_m", "0"}, OutOfRange{"emission_radius_m", "-5"},
                      OutOfRange{"gate_enter_m", "0"}, OutOfRange{"gate_exit_m", "inf"},
                      OutOfRange{"beacon_age_limit_ms", "14"}, OutOfRange{"behaviour", "7"}),
    NameOf);

class ProfileOutOfRange : public ::testing::TestWithParam<OutOfRange> {};

TEST_P(ProfileOutOfRange, IsRefused) {
  const auto [field, value] = GetParam();
  const std::string text = std::string("profile { ") + field + ": " + value + " }";
  EXPECT_THAT(ProblemsOf(kGoodScenario + text),
              ElementsAre(Is(17, std::string("profile.") + field, "must be")));
}

INSTANTIATE_TEST_SUITE_P(
    ScenarioRules, ProfileOutOfRange,
    ::testing::Values(OutOfRange{"body_radius_m", "-0.25"}, OutOfRange{"body_radius_m", "0.04"},
                      OutOfRange{"wheel_radius_m", "0"}, OutOfRange{"axle_m", "nan"},
                      OutOfRange{"max_speed_m_s", "21"}, OutOfRange{"max_turn_rad_s", "0"},
                      OutOfRange{"acceleration_m_s2", "0"}, OutOfRange{"deceleration_m_s2", "-1"},
                      OutOfRange{"wheel_slip", "0.51"}, OutOfRange{"encoder_noise", "-0.1"}),
    NameOf);

TEST(ScenarioRules, AtMost16384VehiclesAreRead) {
  std::string text = "name: \"many\" expect {}\n";
  for (int i = 0; i < 16385; ++i) text += "vehicle {}\n";
  EXPECT_THAT(ProblemsOf(text),
              ElementsAre(Is(16386, "vehicle[16384]", "is one of 16385; at most 16384")));
}

TEST(ScenarioRules, AListOfIdsHasAnEnd) {
  std::string ids = "1";
  for (int i = 0; i < 16384; ++i) ids += ", 1";
  EXPECT_THAT(ProblemsOf(Edited("arrived: [1]", "arrived: [" + ids + "]")),
              ElementsAre(Is(16, "expect.arrived", "16385 values; at most 16384")));
}

TEST(ScenarioRules, AllProblemsComeAtOnceInOrderOfLines) {
  std::string text = Edited("cruise_m_s: 0.4", "cruise_m_s: 9 foo: 1");
  text = "seed: 3 area: \"A\"\n" + text + "duration_s: nan\n";
  EXPECT_THAT(ProblemsOf(text), ElementsAre(Is(1, "area", "a-z"), Is(7, "foo", "no field"),
                                            Is(7, "vehicle[0].cruise_m_s", "above 0"),
                                            Is(18, "duration_s", "finite")));
}

TEST(ScenarioRules, AFileOfNonsenseIsToldInAHundredProblems) {
  std::string text = kGoodScenario;
  for (int i = 0; i < 1000; ++i) text += "foo: 1\n";
  const auto problems = ProblemsOf(text);
  ASSERT_EQ(problems.size(), 101U);
  EXPECT_THAT(problems.back().message, HasSubstr("more than 100"));
}

TEST(ScenarioRules, ADurationAskedForInsteadIsCheckedToo) {
  ScenarioOverrides overrides;
  overrides.duration_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ProblemsOf(kGoodScenario, overrides),
              ElementsAre(Is(1, "", "the duration asked for instead")));
}

TEST(ScenarioRules, ASeedThatPushesBodiesIntoEachOtherIsRefusedByName) {
  const std::string text = Edited("x_m: 0 y_m: -3", "x_m: -4 y_m: 0.501");
  int refused = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    ScenarioOverrides overrides;
    overrides.seed = seed;
    const auto problems = ProblemsOf(text, overrides);
    if (problems.empty()) continue;
    ++refused;
    const std::string cause = "with seed " + std::to_string(seed);
    EXPECT_THAT(problems, ElementsAre(Is(11, "vehicle[1].start", cause)));
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace giveway

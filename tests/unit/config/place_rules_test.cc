// One test a rule about the place, boxes, sonar, signals and spawn places. What is appended to the
// good text stands on line 17.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<Problem> With(const std::string& text) { return ProblemsOf(kGoodScenario + text); }

const std::string kLine = "line { from { x_m: -1 y_m: -1 } to { x_m: -1 y_m: 1 } } ";

TEST(PlaceRules, SlotsShorterThanAnEchoAreRefused) {
  EXPECT_THAT(With("sonar { tier: p3dx slot_ms: 29 }"),
              ElementsAre(Is(17, "sonar.slot_ms", "between 30 and 200 ms")));
}

TEST(PlaceRules, AbsurdSonarsAreRefusedAllAtOnce) {
  EXPECT_THAT(
      With("sonar { tier: typical blind_m: 2 noise: 0.51 max_incidence_deg: 0.5 "
           "drop_out: 1 }"),
      ::testing::UnorderedElementsAre(Is(17, "sonar.blind_m", "between 0 and 1 m"),
                                      Is(17, "sonar.noise", "between 0 and 0.5"),
                                      Is(17, "sonar.max_incidence_deg", "between 1 and 90 degrees"),
                                      Is(17, "sonar.drop_out", "between 0 and 0.9")));
  EXPECT_THAT(With("sonar { tier: typical noise: nan }"),
              ElementsAre(Is(17, "sonar.noise", "not a finite number")));
}

TEST(PlaceRules, ARefreshOfMoreThanAHundredTicksIsRefused) {
  EXPECT_THAT(With("tick_period_ms: 5 sonar { tier: p3dx slot_ms: 70 }"),
              ElementsAre(Is(17, "sonar.slot_ms", "every 112 ticks")));
  EXPECT_THAT(With("tick_period_ms: 5 sonar { tier: p3dx slot_ms: 63 }"),
              ElementsAre(Is(17, "sonar.slot_ms", "every 101 ticks")));  // 100.8
  EXPECT_THAT(With("tick_period_ms: 5 sonar { tier: p3dx slot_ms: 62.5 }"), IsEmpty());
}

TEST(PlaceRules, ANumberWithoutEffectInItsTierIsRefused) {
  EXPECT_THAT(With("sonar { noise: 0.1 }"),
              ElementsAre(Is(17, "sonar.noise", "no effect below tier typical")));
  EXPECT_THAT(With("sonar { tier: typical slot_ms: 40 }"),
              ElementsAre(Is(17, "sonar.slot_ms", "no effect below tier p3dx")));
}

TEST(PlaceRules, ABodyHasOneShape) {
  EXPECT_THAT(With("profile { body_radius_m: 0.3 box { half_length_m: 0.4 half_width_m: 0.3 } }"),
              ElementsAre(Is(17, "profile.body_radius_m", "together with box")));
  EXPECT_THAT(With("profile { box { half_length_m: 0.04 } }"),
              ElementsAre(Is(17, "profile.box.half_length_m", "between 0.05 and 10 m"),
                          Is(17, "profile.box.half_width_m", "missing")));
}

TEST(PlaceRules, WallsLeavesAndStopLinesHaveALength) {
  const std::string ends = "from { x_m: 8 y_m: 1 } to { x_m: 8 y_m: 1.0001 }";
  EXPECT_THAT(With("wall { " + ends + " }"),
              ElementsAre(Is(17, "wall[1].to", "the wall has no length")));
  EXPECT_THAT(With("door { " + ends + " }"),
              ElementsAre(Is(17, "door[0].to", "the door has no length")));
  EXPECT_THAT(With("signal { id: 1 line { " + ends + " } heading_deg: 0 }"),
              ElementsAre(Is(17, "signal[0].line.to", "the stop line has no length")));
}

TEST(PlaceRules, AOneLaneSectionHasTwoEndsAndAWidth) {
  EXPECT_THAT(With("one_lane { from { x_m: 8 y_m: 1 } to { x_m: 8 y_m: 1 } width_m: 0.01 }"),
              ElementsAre(Is(17, "one_lane[0].to", "the one-lane section has no length"),
                          Is(17, "one_lane[0].width_m", "between 0.1 and 100 m")));
  EXPECT_THAT(With("one_lane { from { x_m: nan y_m: 1 } width_m: 1 }"),
              ElementsAre(Is(17, "one_lane[0].from.x_m", "not a finite number"),
                          Is(17, "one_lane[0].to", "missing")));
}

TEST(PlaceRules, ThereAreAtMostSixtyFourOneLaneSections) {
  std::string text;
  for (int i = 0; i < 65; ++i) {
    text += "one_lane { from { x_m: 0 y_m: 0 } to { x_m: 1 y_m: 0 } width_m: 1 } ";
  }
  EXPECT_THAT(With(text), ElementsAre(Is(17, "one_lane[64]", "at most 64")));
}

TEST(PlaceRules, AnObstacleHasOneShapeAndAPlace) {
  EXPECT_THAT(With("obstacle { }"), ElementsAre(Is(17, "obstacle[0]", "no shape"),
                                                Is(17, "obstacle[0].start", "missing")));
  EXPECT_THAT(With("obstacle { disc_radius_m: 1 box { half_length_m: 1 half_width_m: 1 } "
                   "start { x_m: 8 y_m: 0 } }"),
              ElementsAre(Is(17, "obstacle[0].disc_radius_m", "together with box")));
  EXPECT_THAT(With("obstacle { disc_radius_m: 0.001 start { x_m: nan y_m: inf } }"),
              ElementsAre(Is(17, "obstacle[0].disc_radius_m", "between 0.01 and 10"),
                          Is(17, "obstacle[0].start.x_m", "finite"),
                          Is(17, "obstacle[0].start.y_m", "finite")));
}

TEST(PlaceRules, WhatMovesHasAWayAndASpeed) {
  const std::string disc = "obstacle { disc_radius_m: 0.1 start { x_m: 8 y_m: 0 } ";
  EXPECT_THAT(With(disc + "speed_m_s: 1 }"),
              ElementsAre(Is(17, "obstacle[0].speed_m_s", "there is no waypoint")));
  EXPECT_THAT(With(disc + "loop: true }"),
              ElementsAre(Is(17, "obstacle[0].loop", "there is no waypoint")));
  EXPECT_THAT(With(disc + "waypoint { x_m: 9 y_m: 0 } }"),
              ElementsAre(Is(17, "obstacle[0].speed_m_s", "missing")));
  EXPECT_THAT(With(disc + "waypoint { x_m: 9 y_m: 0 } speed_m_s: 10.1 }"),
              ElementsAre(Is(17, "obstacle[0].speed_m_s", "at most 10 m/s")));
  EXPECT_THAT(With(disc + "waypoint { x_m: 9 y_m: 0 } speed_m_s: 0 }"),
              ElementsAre(Is(17, "obstacle[0].speed_m_s", "above 0")));
}

TEST(PlaceRules, EveryLegOfAWayLeadsSomewhere) {
  const std::string disc = "obstacle { disc_radius_m: 0.1 start { x_m: 8 y_m: 0 } speed_m_s: 1 ";
  EXPECT_THAT(With(disc + "waypoint { x_m: 9 y_m: 0 } waypoint { x_m: 9 y_m: 0 } }"),
              ElementsAre(Is(17, "obstacle[0].waypoint[1]", "where the obstacle is already")));
  const std::string there_and_back = disc + "waypoint { x_m: 9 y_m: 0 } waypoint { x_m: 8 y_m: 0 }";
  EXPECT_THAT(With(there_and_back + " loop: true }"),
              ElementsAre(Is(17, "obstacle[0].waypoint[1]", "returns by itself")));
  EXPECT_THAT(With(there_and_back + " }"), IsEmpty());
}

TEST(PlaceRules, ALeafFasterThanTenMetresASecondIsRefused) {
  EXPECT_THAT(With("door { from { x_m: 8 y_m: 0 } to { x_m: 9 y_m: 0 } move_s: 0.09 }"),
              ElementsAre(Is(17, "door[0].move_s", "slide at 11.11 m/s")));
}

TEST(PlaceRules, ALeafDoesNotCutThroughWallsOrOtherLeaves) {
  EXPECT_THAT(With("door { from { x_m: 0 y_m: 2 } to { x_m: 0 y_m: 4 } }"),
              ElementsAre(Is(17, "door[0].to", "crosses wall[0]")));
  EXPECT_THAT(With("door { from { x_m: 8 y_m: 0 } to { x_m: 9 y_m: 0 } } "
                   "door { from { x_m: 8.5 y_m: -1 } to { x_m: 8.5 y_m: 1 } }"),
              ElementsAre(Is(17, "door[1].to", "crosses door[0]")));
  EXPECT_THAT(With("door { from { x_m: 5 y_m: 3 } to { x_m: 6 y_m: 3 } } "
                   "door { from { x_m: 7 y_m: 3 } to { x_m: 6 y_m: 3 } }"),
              IsEmpty());
}

TEST(PlaceRules, NothingStandsInADoorwayAtTheStart) {
  EXPECT_THAT(With("door { from { x_m: -4.5 y_m: 0.2 } to { x_m: -3 y_m: 0.2 } }"),
              ElementsAre(Is(5, "vehicle[0].start", "overlaps the doorway of door[0], 0.200 m")));
}

TEST(PlaceRules, ObstaclesAndSpawnPlacesKeepClearOfAllOthers) {
  EXPECT_THAT(With("obstacle { disc_radius_m: 0.3 start { x_m: -4 y_m: 0.5 } }"),
              ElementsAre(Is(17, "obstacle[0].start", "obstacle[0] overlaps vehicle 1")));
  EXPECT_THAT(With("obstacle { disc_radius_m: 0.3 start { x_m: 4 y_m: 2.8 } "
                   "waypoint { x_m: 4 y_m: 1 } speed_m_s: 0.1 }"),
              ElementsAre(Is(17, "obstacle[0].start", "obstacle[0] overlaps wall[0]")));
  EXPECT_THAT(With("spawn { start { x_m: 0 y_m: -3.4 heading_deg: 0 } cruise_m_s: 0.3 }"),
              ElementsAre(Is(17, "spawn[0].start", "spawn[0] overlaps vehicle 2")));
  EXPECT_THAT(With("spawn { start { x_m: 7 y_m: 0 heading_deg: 0 } cruise_m_s: 0.3 }"
                   "obstacle { disc_radius_m: 0.3 start { x_m: 7 y_m: 0.5 } }"),
              ElementsAre(Is(17, "obstacle[0].start", "obstacle[0] overlaps spawn[0]")));
}

TEST(PlaceRules, ObstaclesThatStandMayOverlapEachOtherAndWalls) {
  EXPECT_THAT(With("obstacle { disc_radius_m: 0.3 start { x_m: 4 y_m: 2.8 } }"), IsEmpty());
  const std::string box = "obstacle { disc_radius_m: 0.3 start { x_m: 7 y_m: 0 } ";
  EXPECT_THAT(With(box + "}" + box + "}"), IsEmpty());
  EXPECT_THAT(With(box + "}" + box + "waypoint { x_m: 9 y_m: 0 } speed_m_s: 0.1 }"),
              ElementsAre(Is(17, "obstacle[1].start", "obstacle[1] overlaps obstacle[0]")));
}

TEST(PlaceRules, BoxesAreComparedAsBoxes) {
  const auto boxes = [](double y_m) {
    return With(
        "profile { box { half_length_m: 1 half_width_m: 0.1 } } "
        "obstacle { box { half_length_m: 1 half_width_m: 0.1 } start { x_m: -4 y_m: " +
        std::to_string(y_m) + " } }");
  };
  EXPECT_THAT(boxes(0.21), IsEmpty());
  EXPECT_THAT(boxes(0.19), ElementsAre(Is(17, "obstacle[0].start", "overlaps vehicle 1")));
}

TEST(PlaceRules, ASpawnPlaceIsReadLikeAVehicle) {
  EXPECT_THAT(With("spawn { }"), ElementsAre(Is(17, "spawn[0].start", "missing"),
                                             Is(17, "spawn[0].cruise_m_s", "missing")));
  EXPECT_THAT(With("spawn { start { x_m: 7 y_m: 0 heading_deg: 0 } cruise_m_s: 0.3 "
                   "goal { x_m: 7 y_m: 0 } }"),
              ElementsAre(Is(17, "spawn[0].start", "inside the vehicle's own goal")));
}

TEST(PlaceRules, AnOpenFleetStartsWithAtMostAllOfIt) {
  const std::string spawn = "spawn { start { x_m: 7 y_m: 0 heading_deg: 0 } cruise_m_s: 0.3 } ";
  EXPECT_THAT(With(spawn + "start_with: 4"), ElementsAre(Is(17, "start_with", "between 1 and 3")));
  EXPECT_THAT(With(spawn + "start_with: 0"), ElementsAre(Is(17, "start_with", "between 1 and 3")));
  EXPECT_THAT(With("start_with: 1"), ElementsAre(Is(17, "start_with", "there is no spawn")));
}

TEST(PlaceRules, WhoJoinsWithoutAGoalCannotBeExpectedToArrive) {
  const std::string spawn = "spawn { start { x_m: 7 y_m: 0 heading_deg: 0 } cruise_m_s: 0.3 } ";
  EXPECT_THAT(ProblemsOf(Edited("arrived: [1]", "arrived: [1, 3]") + spawn),
              ElementsAre(Is(16, "expect.arrived", "vehicle 3 has no goal")));
}

TEST(PlaceRules, ASetIsNotNamedAndLeftOpenAtOnce) {
  EXPECT_THAT(ProblemsOf(Edited("arrived: [1]", "arrived: [1] any_arrived: true")),
              ElementsAre(Is(16, "expect.any_arrived", "together with arrived")));
}

TEST(PlaceRules, SignalIdsAreUnique) {
  const std::string signal = "signal { id: 3 " + kLine + "heading_deg: 0 } ";
  EXPECT_THAT(With(signal + signal), ElementsAre(Is(17, "signal[1].id", "another signal has")));
  EXPECT_THAT(With("signal { id: 0 " + kLine + "heading_deg: 0 }"),
              ElementsAre(Is(17, "signal[0].id", "between 1 and")));
}

TEST(PlaceRules, ASignalNeedsIdLineAndHeading) {
  EXPECT_THAT(With("signal { }"),
              ElementsAre(Is(17, "signal[0].id", "missing"), Is(17, "signal[0].line", "missing"),
                          Is(17, "signal[0].heading_deg", "missing")));
}

TEST(PlaceRules, TrafficCrossesItsStopLine) {
  EXPECT_THAT(With("signal { id: 3 " + kLine + "heading_deg: 81 }"),
              ElementsAre(Is(17, "signal[0].heading_deg", "along the stop line")));
  EXPECT_THAT(With("signal { id: 3 " + kLine + "heading_deg: -99 }"),
              ElementsAre(Is(17, "signal[0].heading_deg", "along the stop line")));
  EXPECT_THAT(With("signal { id: 3 " + kLine + "heading_deg: 79 }"), IsEmpty());
}

TEST(PlaceRules, PhasesHaveABeginningAndAnEnd) {
  EXPECT_THAT(With("signal { id: 3 " + kLine +
                   "heading_deg: 0 green_s: 0 yellow_s: -1 red_s: inf offset_s: nan }"),
              ::testing::SizeIs(4));
}

TEST(PlaceRules, HeadsOfAGroupAreNeverGreenOrYellowTogether) {
  const auto heads = [](const std::string& second) {
    return With("signal { id: 3 group: 1 " + kLine + "heading_deg: 0 }\n" +
                "signal { id: 4 group: " + second + " " + kLine + "heading_deg: 0 }");
  };
  EXPECT_THAT(heads("1 offset_s: 13"), IsEmpty());
  EXPECT_THAT(heads("2"), IsEmpty());
  EXPECT_THAT(heads("1 offset_s: 12"),
              ElementsAre(Is(18, "signal[1].group", "signals 3 and 4 of this group")));
}

TEST(PlaceRules, AFaultHasOneVictim) {
  EXPECT_THAT(
      With("fault { kill: 1 dark: 3 at_s: 1 } signal { id: 3 " + kLine + "heading_deg: 0 }"),
      ElementsAre(Is(17, "fault[1]", "more than one of kill, dark and silent")));
}

TEST(PlaceRules, AFaultOfASignalNeedsAKnownOneAndATime) {
  EXPECT_THAT(With("fault { dark: 3 at_s: 1 }"),
              ElementsAre(Is(17, "fault[1].dark", "no signal has this id")));
  const std::string signal = "signal { id: 3 " + kLine + "heading_deg: 0 } ";
  EXPECT_THAT(With(signal + "fault { silent: 3 }"),
              ElementsAre(Is(17, "fault[1].at_s", "missing")));
  EXPECT_THAT(With(signal + "fault { silent: 3 at_s: 1 before_crossing_m: 1 }"),
              ElementsAre(Is(17, "fault[1].before_crossing_m", "condition of kill only")));
}

std::string Times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(PlaceRules, CountsHaveALimit) {
  EXPECT_THAT(With(Times(65537, "wall {}\n")),
              ElementsAre(Is(65552, "wall[65536]", "is one of 65538; at most 65536")));
  EXPECT_THAT(With(Times(16385, "obstacle {}\n")),
              Contains(Is(16401, "obstacle[16384]", "at most 16384")));
  EXPECT_THAT(With(Times(1025, "door {}\n")), Contains(Is(1041, "door[1024]", "at most 1024")));
  EXPECT_THAT(With(Times(1025, "signal {}\n")), Contains(Is(1041, "signal[1024]", "at most 1024")));
  EXPECT_THAT(With(Times(16383, "spawn {}\n")), Contains(Is(1, "", "16385 of vehicle and spawn")));
}

// 38 MB: refused by its size, before it is parsed.
TEST(PlaceRules, AMillionWallsAreTooLargeAFile) {
  const auto problems = With(Times(1'000'000, "wall{from{x_m:0 y_m:9}to{x_m:1 y_m:9}}"));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].message, HasSubstr("8388608"));
}

TEST(PlaceRules, AMillionWallsInFewBytesAreTooMany) {
  EXPECT_THAT(With(Times(1'000'000, "wall{}")),
              ElementsAre(Is(17, "wall[65536]", "is one of 1000001; at most 65536")));
}

// The largest fleet allowed, in rows and columns with walls between: comparing pair by pair would
// take over a thousand million pairs.
TEST(PlaceRules, AFullFleetAmongManyWallsIsCheckedAtOnce) {
  std::string text = "name: \"full\" expect {}\n";
  for (int i = 0; i < 16384; ++i) {
    text += "vehicle{id:" + std::to_string(i + 1) +
            " cruise_m_s:.3 start{x_m:" + std::to_string(2 * (i % 128)) +
            " y_m:" + std::to_string(2 * (i / 128)) + " heading_deg:0}}\n";
  }
  for (int i = 0; i < 16384; ++i) {
    const std::string x = std::to_string(2 * (i % 128) + 1);
    const std::string y = std::to_string(2 * (i / 128));
    text += "wall{from{x_m:" + x + " y_m:" + y + "}to{x_m:" + x + ".5 y_m:" + y + "}}\n";
  }
  EXPECT_EQ(Load(text).vehicles.size(), 16384U);
}

TEST(PlaceRules, AnOpenFleetLargerThanAnyCanBeIsRefused) {
  const auto place = [](int i) {
    return " cruise_m_s:.3 start{x_m:" + std::to_string(2 * (i % 128)) +
           " y_m:" + std::to_string(2 * (i / 128)) + " heading_deg:0}}\n";
  };
  std::string text = "name: \"open\" expect {}\n";
  for (int i = 0; i < 1024; ++i) text += "vehicle{id:" + std::to_string(i + 1) + place(i);
  EXPECT_THAT(ProblemsOf(text + "spawn{" + place(5000) + "start_with: 1025"),
              ElementsAre(Is(1027, "start_with", "between 1 and 1024")));
  text += "vehicle{id:9999" + place(4000);
  EXPECT_THAT(ProblemsOf(text), IsEmpty());
  EXPECT_THAT(ProblemsOf(text + "spawn{" + place(5000)),
              ElementsAre(Is(1026, "vehicle[1024]", "at most 1024 at any one time")));
}

TEST(PlaceRules, AFullFleetOnOneSpotIsRefusedAtOnce) {
  std::string text = "name: \"full\" expect {}\n";
  for (int i = 0; i < 16384; ++i) {
    text += "vehicle{id:" + std::to_string(i + 1) +
            " cruise_m_s:.3 start{x_m:0 y_m:0 heading_deg:0}}\n";
  }
  const auto problems = ProblemsOf(text);
  ASSERT_EQ(problems.size(), 101U);
  EXPECT_THAT(problems[0].message, HasSubstr("vehicle 2 overlaps vehicle 1"));
}

}  // namespace
}  // namespace giveway

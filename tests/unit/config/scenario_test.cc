// What a scenario file becomes; and every file this project ships or refuses on purpose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "services/config/config_dir.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/types/math/math.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

std::vector<std::string> FilesIn(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".textproto") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string StemOf(const ::testing::TestParamInfo<std::string>& info) {
  return fs::path(info.param).stem();
}

class ShippedScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedScenario, LoadsUnderItsNameAndSaysWhatItIs) {
  const Scenario scenario = LoadScenario(GetParam(), {});
  EXPECT_EQ(scenario.name, fs::path(GetParam()).stem());
  EXPECT_FALSE(scenario.description.empty());
  EXPECT_EQ(scenario.seed, 0U);
}

TEST_P(ShippedScenario, LoadsWithEverySeedOfTheFirstHundred) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    ScenarioOverrides overrides;
    overrides.seed = seed;
    EXPECT_NO_THROW(LoadScenario(GetParam(), overrides)) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Config, ShippedScenario,
                         ::testing::ValuesIn(FilesIn(fs::path(ConfigDir()) / "scenarios")), StemOf);

// The first line of each file is "# EXPECT" and what the error says.
class BadScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(BadScenario, IsRefusedWithTheWordsItStates) {
  std::string expected;
  std::getline(std::ifstream(GetParam()), expected);
  ASSERT_EQ(expected.substr(0, 9), "# EXPECT ");
  try {
    LoadScenario(GetParam(), {});
    FAIL() << "loaded";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam() + expected.substr(9)));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, BadScenario,
                         ::testing::ValuesIn(FilesIn(fs::path(ConfigDir()) /
                                                     "../tests/unit/config/bad_scenarios")),
                         StemOf);

TEST(Scenario, ADurationOfZeroLastsUntilItIsStopped) {
  EXPECT_TRUE(IsEndless(Load(kGoodScenario + "duration_s: 0")));
  EXPECT_FALSE(IsEndless(Load(kGoodScenario)));
}

TEST(Scenario, TheFiveOfTheCrossingAreShipped) {
  for (const char* name : {"intersection_yield", "intersection_equal", "intersection_avoid",
                           "wall_only", "peer_dies"}) {
    EXPECT_EQ(LoadScenario(name, {}).name, name);
  }
}

TEST(Scenario, TheSixOfRightOfWayAreShipped) {
  for (const char* name :
       {"head_on", "three_way", "four_way", "deaf", "parked_nose_to_nose", "convoy"}) {
    EXPECT_EQ(LoadScenario(name, {}).name, name);
  }
}

// d / v + v / (2 a): the time from standstill to the crossing.
double ArrivalAtCrossing(const Scenario& scenario, const VehicleOptions& vehicle) {
  const double way_m = Norm(vehicle.start_world.position_world - scenario.crossing_world);
  return way_m / vehicle.cruise_m_s + vehicle.cruise_m_s / (2 * vehicle.profile.acceleration_m_s2);
}

TEST(Scenario, TheVehiclesOfEveryCrossingArriveTogether) {
  for (const char* name :
       {"intersection_yield", "intersection_equal", "intersection_avoid", "peer_dies"}) {
    const Scenario scenario = LoadScenario(name, {});
    ASSERT_EQ(scenario.vehicles.size(), 2U);
    EXPECT_NEAR(ArrivalAtCrossing(scenario, scenario.vehicles[0]),
                ArrivalAtCrossing(scenario, scenario.vehicles[1]), 1e-9)
        << name;
  }
}

TEST(Scenario, ADefaultIsTheOneTheTypesState) {
  const Scenario scenario = Load(kGoodScenario);
  EXPECT_EQ(scenario.area, "main");
  EXPECT_EQ(scenario.tick_period, std::chrono::milliseconds{50});
  EXPECT_EQ(scenario.duration_s, Scenario{}.duration_s);
  const VehicleOptions& vehicle = scenario.vehicles[1];
  EXPECT_EQ(vehicle.behaviour, Behaviour::kCooperative);
  EXPECT_EQ(vehicle.ranges_age_limit, VehicleOptions{}.ranges_age_limit);
  EXPECT_EQ(vehicle.gate_enter_m, VehicleOptions{}.gate_enter_m);
  EXPECT_EQ(vehicle.silent_body_stays, VehicleOptions{}.silent_body_stays);
  EXPECT_EQ(vehicle.distance_metric, DistanceMetric::kEuclidean);
  EXPECT_EQ(scenario.expect.halted_for, std::nullopt);
  EXPECT_FALSE(vehicle.goal.set);
  EXPECT_FALSE(vehicle.profile.sonar[8].enabled);
}

TEST(Scenario, EveryFieldReachesItsPlace) {
  const Scenario scenario = Load(R"(
    name: "all" description: "d" area: "a" seed: 0 tick_period_ms: 20 duration_s: 7
    start_timeout_s: 8 remove_after_s: 0 watchdog_ticks: 4 emission_radius_m: 9 gate_enter_m: 1.5
    gate_exit_m: 1.75 beacon_age_limit_ms: 100 crossing { x_m: 1 y_m: 2 }
    profile { wheel_radius_m: 0.1 axle_m: 0.4 max_turn_rad_s: 2 rear_sonar: true }
    behaviour: stock_avoid
    vehicle { id: 7 start { x_m: 3 y_m: 4 heading_deg: -180 } cruise_m_s: 1.5
              goal { x_m: 9 y_m: 8 radius_m: 0.5 } behaviour: lecture_yield
              distance_metric: chebyshev
              profile { body_radius_m: 0.3 max_speed_m_s: 2 acceleration_m_s2: 1
                        deceleration_m_s2: 3 rear_sonar: false } }
    wall { from { x_m: 20 y_m: 21 } to { x_m: 22 y_m: 23 } }
    fault { kill: 7 at_s: 1 before_crossing_m: 2 }
    expect { contacts: 1 halted: [7] halted_for: deaf arrived: [7] parted: true min_separation_m: 0.5
             time_to_clear_s: 6 })");
  EXPECT_EQ(scenario.description, "d");
  EXPECT_EQ(scenario.area, "a");
  EXPECT_EQ(scenario.tick_period, std::chrono::milliseconds{20});
  EXPECT_EQ(scenario.duration_s, 7);
  EXPECT_EQ(scenario.start_timeout_s, 8);
  EXPECT_EQ(scenario.remove_after_s, 0);
  EXPECT_EQ(scenario.watchdog_ticks, 4U);
  EXPECT_EQ(scenario.crossing_world, (Vec2{1, 2}));
  ASSERT_EQ(scenario.vehicles.size(), 1U);
  const VehicleOptions& v = scenario.vehicles[0];
  EXPECT_EQ(v.id, VehicleId{7});
  EXPECT_EQ(v.start_world, (Pose{{3, 4}, kPi}));
  EXPECT_EQ(v.cruise_m_s, 1.5);
  EXPECT_TRUE(v.goal.set);
  EXPECT_EQ(v.goal.at_world, (Vec2{9, 8}));
  EXPECT_EQ(v.goal.radius_m, 0.5);
  EXPECT_EQ(v.behaviour, Behaviour::kLectureYield);
  EXPECT_EQ(v.distance_metric, DistanceMetric::kChebyshev);
  EXPECT_EQ(v.profile.drive.wheel_radius_m, 0.1);
  EXPECT_EQ(v.profile.drive.axle_m, 0.4);
  EXPECT_EQ(v.profile.max_turn_rad_s, 2);
  EXPECT_EQ(v.profile.body_radius_m, 0.3);
  EXPECT_EQ(v.profile.max_speed_m_s, 2);
  EXPECT_EQ(v.profile.acceleration_m_s2, 1);
  EXPECT_EQ(v.profile.deceleration_m_s2, 3);
  EXPECT_FALSE(v.profile.sonar[8].enabled);
  EXPECT_EQ(v.tick_period, std::chrono::milliseconds{20});
  EXPECT_EQ(v.ranges_age_limit, std::chrono::milliseconds{60});
  EXPECT_EQ(v.beacon_age_limit, std::chrono::milliseconds{100});
  EXPECT_EQ(v.silent_body_stays, std::chrono::seconds{1});  // removed as soon as it is silent
  EXPECT_EQ(v.emission_radius_m, 9);
  EXPECT_EQ(v.gate_enter_m, 1.5);
  EXPECT_EQ(v.gate_exit_m, 1.75);
  ASSERT_EQ(scenario.walls.size(), 1U);
  EXPECT_EQ(scenario.walls[0].from_world, (Vec2{20, 21}));
  EXPECT_EQ(scenario.walls[0].to_world, (Vec2{22, 23}));
  ASSERT_EQ(scenario.faults.size(), 1U);
  EXPECT_EQ(scenario.faults[0].vehicle, VehicleId{7});
  EXPECT_EQ(scenario.faults[0].at_s, 1);
  EXPECT_EQ(scenario.faults[0].before_crossing_m, 2);
  EXPECT_EQ(scenario.expect.contacts, 1U);
  EXPECT_THAT(scenario.expect.halted, ElementsAre(VehicleId{7}));
  EXPECT_EQ(scenario.expect.halted_for, Rule::kUnidentifiedMotion);
  EXPECT_THAT(scenario.expect.arrived, ElementsAre(VehicleId{7}));
  EXPECT_TRUE(scenario.expect.parted);
  EXPECT_EQ(scenario.expect.min_separation_m, 0.5);
  EXPECT_EQ(scenario.expect.time_to_clear_s, 6);
}

TEST(Scenario, VehiclesAndExpectedIdsComeSorted) {
  const std::string third =
      "vehicle { id: 1 start { x_m: 9 y_m: 0 heading_deg: 0 } cruise_m_s: 1 goal {x_m: 0 y_m: 0} }";
  const Scenario scenario = Load(Edited("id: 1\n", "id: 3\n") + third + "# 1 was last");
  EXPECT_EQ(scenario.vehicles[0].id, VehicleId{1});
  EXPECT_EQ(scenario.vehicles[0].start_world.position_world.x, 9);
  EXPECT_EQ(scenario.vehicles[2].id, VehicleId{3});
}

TEST(Scenario, TheNamesOfBehavioursAreThoseOfTheSchema) {
  for (const Behaviour behaviour :
       {Behaviour::kCooperative, Behaviour::kLectureAvoid, Behaviour::kStockAvoid,
        Behaviour::kLectureYield, Behaviour::kLecturePrinted}) {
    const std::string line = "behaviour: " + std::string(Name(behaviour));
    EXPECT_EQ(Load(kGoodScenario + line).vehicles[0].behaviour, behaviour);
  }
}

TEST(Scenario, TheNamesOfMetricsAreThoseOfTheSchema) {
  for (const DistanceMetric metric :
       {DistanceMetric::kEuclidean, DistanceMetric::kManhattan, DistanceMetric::kChebyshev}) {
    const std::string line = "id: 1 distance_metric: " + std::string(Name(metric));
    EXPECT_EQ(Load(Edited("id: 1", line)).vehicles[0].distance_metric, metric);
  }
}

TEST(Scenario, TheNamesOfReasonsAreThoseOfTheSchema) {
  for (const Rule rule :
       {Rule::kGiveWay, Rule::kNotGranted, Rule::kPeerLost, Rule::kUnidentifiedMotion}) {
    const std::string line = "any_halted: true halted_for: " + std::string(Name(rule)) + " }";
    EXPECT_EQ(Load(Edited("arrived: [1] }", line)).expect.halted_for, rule);
  }
}

TEST(Scenario, TheWeightsAreThoseOfTheBehaviourUnlessWritten) {
  const auto weights = [](const std::string& text) {
    return Load(kGoodScenario + text).vehicles[0].braitenberg;
  };
  EXPECT_EQ(weights("behaviour: lecture_avoid").left, LectureWeights().left);
  EXPECT_EQ(weights("behaviour: stock_avoid").right, StockWeights().right);
  const std::string own =
      "id: 1 braitenberg { far_gate_m: 2 left: [1,1,1,1,1,1,1,1] "
      "right: [2,2,2,2,2,2,2,2,3,3,3,3,3,3,3,3] }";
  const BraitenbergWeights read = Load(Edited("id: 1", own)).vehicles[0].braitenberg;
  EXPECT_EQ(read.far_gate_m, 2);
  EXPECT_EQ(read.base_rad_s, LectureWeights().base_rad_s);
  EXPECT_EQ(read.left[7], 1);
  EXPECT_EQ(read.left[8], 0);
  EXPECT_EQ(read.right[15], 3);
}

TEST(Scenario, TheCommandLineOverridesTheFile) {
  const std::string text = Edited("id: 1", "id: 1 behaviour: lecture_yield") + "seed: 5";
  ScenarioOverrides overrides;
  overrides.behaviour = Behaviour::kStockAvoid;
  overrides.duration_s = 3;
  overrides.seed = 0;
  const Scenario scenario = Load(text, overrides);
  EXPECT_EQ(scenario.duration_s, 3);
  EXPECT_EQ(scenario.seed, 0U);
  EXPECT_EQ(scenario.vehicles[0].behaviour, Behaviour::kStockAvoid);
  EXPECT_EQ(scenario.vehicles[1].behaviour, Behaviour::kStockAvoid);
  EXPECT_EQ(scenario.vehicles[0].braitenberg.left, StockWeights().left);
  EXPECT_EQ(scenario.vehicles[0].start_world.position_world, (Vec2{-4, 0}));
}

TEST(Scenario, AnAbsentScenarioIsRefusedWithTheNamesThereAre) {
  try {
    ResolveScenario("no_such_scenario");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("scenarios/no_such_scenario.textproto"));
    EXPECT_THAT(error.what(), HasSubstr("intersection_avoid, intersection_equal"));
  }
  EXPECT_THROW(ResolveScenario(""), InputError);
}

TEST(Scenario, AFileComesBeforeTheShippedScenarioOfItsName) {
  const TempFolder folder;
  const std::string file = folder.Write("wall_only", kGoodScenario);
  EXPECT_EQ(ResolveScenario(file), file);
  EXPECT_THAT(ResolveScenario("wall_only"), HasSubstr("scenarios/wall_only.textproto"));
}

// Regression: a folder of that name where a program was started hid the shipped scenario.
TEST(Scenario, AFolderDoesNotHideWhatIsShippedUnderItsName) {
  const TempFolder folder;
  for (const char* const name : {"wall_only", "nightly", "lossy_radio"}) {
    fs::create_directory(folder.Path() + "/" + name);
  }
  const fs::path before = fs::current_path();
  fs::current_path(folder.Path());
  EXPECT_THAT(ResolveScenario("wall_only"), HasSubstr("scenarios/wall_only.textproto"));
  EXPECT_THAT(ResolveCampaign("nightly"), HasSubstr("campaigns/nightly.textproto"));
  EXPECT_THAT(ResolveQosFile("lossy_radio"), HasSubstr("qos/lossy_radio.xml"));
  fs::current_path(before);
  EXPECT_THROW(ResolveScenario(folder.Path()), InputError);
}

TEST(Scenario, TheConfigFolderCanBeNamed) {
  const TempFolder folder;
  fs::create_directory(folder.Path() + "/scenarios");
  setenv("GIVEWAY_CONFIG_DIR", folder.Path().c_str(), 1);
  EXPECT_EQ(ConfigDir(), folder.Path());
  fs::remove(folder.Path() + "/scenarios");
  EXPECT_THROW(ConfigDir(), InputError);
  unsetenv("GIVEWAY_CONFIG_DIR");
}

TEST(Scenario, AProblemNeverCommandsTheTerminal) {
  EXPECT_EQ(Format({{"f", 1, "", "\x1b[2J\n", "is bad", "x"}}), "f:1: ?[2J?: is bad; x");
  // Regression: U+009B, which is the same sequence, passed.
  EXPECT_EQ(Format({{"f", 1, "", "\xc2\x9b\x32J", "is bad", "x"}}), "f:1: ?2J: is bad; x");
}

TEST(Scenario, AProblemIsToldOnOneLineWithItsPlace) {
  const Problem whole{"f", 0, "", "", "is empty", "write it"};
  const Problem field{"f", 3, "a.b", "nan", "is not finite", "write a number"};
  const Problem missing{"f", 4, "a.c", "", "is missing", "write it"};
  EXPECT_EQ(Format({whole, field, missing}),
            "f: is empty; write it\n"
            "f:3: a.b = nan: is not finite; write a number\n"
            "f:4: a.c: is missing; write it");
}

}  // namespace
}  // namespace giveway

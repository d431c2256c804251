// A scenario's own list of faults: what a fault file may say, refused by the same rules, and
// carried out together with a fault file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/config/faults/fault_sources.h"
#include "services/config/faults/faults_file.h"
#include "services/config/scenario_file.h"
#include "services/config/writing/scenario_edit.h"
#include "services/faults/schedule_text.h"
#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr faults::Course kMinute{.seed = 5, .duration_s = 60, .warm_up_s = 10, .healing_s = 15};
const std::vector<VehicleId> kTwo = {VehicleId{1}, VehicleId{2}};

const std::string kRules = R"(
at { name: "deaf" time_s: 4 kind: "loss" vehicle: 1 for_s: 6 probability: 0.5 }
at { name: "stands" time_s: 4 kind: "pause" vehicle: 2 for_s: 1 }
random { name: "blind" kind: "sonar_off" mean_between_s: 4 for_s: [0.2, 1] vehicle: [2, 1] }
)";

std::string WithList(const std::string& rules) {
  return kGoodScenario + "faults { " + rules + " }\n";
}

faults::FaultFile OwnOf(const std::string& text) {
  const TempFolder folder;
  return LoadScenarioWithFaults(folder.Write("s.textproto", text), {}).faults.value();
}

TEST(ScenarioFaults, AreThoseThatAFaultFileWithTheSameTextHas) {
  const TempFolder folder;
  const faults::FaultFile own = OwnOf(WithList(kRules));
  const faults::FaultFile file = LoadFaults(folder.Write("f.textproto", kRules));
  const auto expansion = faults::Expand(own, kMinute, kTwo);
  EXPECT_GT(expansion.schedule.size(), 5U);
  EXPECT_EQ(expansion.schedule, faults::Expand(file, kMinute, kTwo).schedule);
}

TEST(ScenarioFaults, AreAbsentUnlessTheFileSaysSo) {
  const TempFolder folder;
  const std::string file = folder.Write("s.textproto", kGoodScenario);
  EXPECT_FALSE(LoadScenarioWithFaults(file, {}).faults);
  EXPECT_THAT(OwnOf(kGoodScenario + "faults { }").at, IsEmpty());
}

TEST(ScenarioFaults, AreRefusedAsInAFaultFileAndWithEverythingElse) {
  const std::string text = Edited("cruise_m_s: 0.4", "cruise_m_s: 40") + R"(faults {
  at { name: "a" time_s: 1 kind: "restrat" vehicle: 1 for_s: 1 }
  random { name: "b" kind: "kill" mean_between_s: 90 for_s: 4 }
  at { name: "c" time_s: 1 kind: "kill" vehicle: 0 }
})";
  const auto problems = ProblemsOf(text);
  ASSERT_THAT(problems, ElementsAre(Is(6, "vehicle[0].cruise_m_s", "1"),
                                    Is(18, "faults.at[0].kind", "is no kind of fault"),
                                    Is(19, "faults.random[0].for_s", "takes no time"),
                                    Is(20, "faults.at[1].vehicle", "between 1")));
  EXPECT_THAT(problems[1].remedy, HasSubstr("write restart,"));
  EXPECT_EQ(problems[1].value, "\"restrat\"");
}

TEST(ScenarioFaults, OfAVehicleThatIsNotThereAreRefusedWhenTheScenarioIsRead) {
  const std::string absent =
      Edited("cruise_m_s: 0.4", "cruise_m_s: 40") +
      "faults {\n"
      "at { name: \"a\" time_s: 9 kind: \"kill\" vehicle: 7 }\n"
      "random { name: \"b\" kind: \"kill\" mean_between_s: 9 vehicle: 8 } }\n"
      "sonar { tier: typical noise: 2 }";
  const auto problems = ProblemsOf(absent);
  ASSERT_THAT(
      problems,
      ElementsAre(Is(6, "vehicle[0].cruise_m_s", "1"), Is(18, "a.vehicle", "there is no vehicle 7"),
                  Is(19, "b.vehicle", "there is no vehicle 8"), Is(20, "sonar.noise", "")));
  EXPECT_THAT(problems[1].file, HasSubstr("s.textproto"));
}

TEST(ScenarioFaults, MayMeetAVehicleThatJoins) {
  const std::string open = kGoodScenario +
                           "spawn { start { x_m: 8 y_m: 0 heading_deg: 90 } cruise_m_s: 0.3 }\n"
                           "faults { at { name: \"a\" time_s: 9 kind: \"kill\" vehicle: ";
  EXPECT_THAT(ProblemsOf(open + "3 } }"), IsEmpty());
  EXPECT_THAT(ProblemsOf(open + "4 } }"), ElementsAre(Is(18, "a.vehicle", "no vehicle 4")));
}

// The run may last longer than the scenario says, and up to a month.
TEST(ScenarioFaults, MayBeOfAnyTimeAndExcludeNone) {
  const std::string late = "at { name: \"a\" time_s: 2592000 kind: \"pause\" vehicle: 1 for_s: 9 }";
  EXPECT_THAT(ProblemsOf(WithList(late)), IsEmpty());
  EXPECT_THAT(
      ProblemsOf(WithList(late + "\nat { name: \"b\" time_s: 2592000 kind: \"hang\" vehicle: 1 "
                                 "for_s: 1 }")),
      ElementsAre(Is(18, "b", "exclude each other")));
}

TEST(ScenarioFaults, AreKeptOrLeftOutByAnEdit) {
  const TempFolder folder;
  const std::string file = folder.Write("s.textproto", WithList(kRules));
  const faults::FaultFile kept = OwnOf(EditScenario(file, {.duration_s = 30.0}));
  EXPECT_EQ(faults::Expand(kept, kMinute, kTwo).schedule,
            faults::Expand(OwnOf(WithList(kRules)), kMinute, kTwo).schedule);
  const std::string plain = EditScenario(file, {.keep_faults = false});
  EXPECT_THAT(plain, testing::Not(HasSubstr("faults")));
  EXPECT_THAT(Load(plain).faults, SizeIs(1));
}

TEST(ScenarioFaults, AnEditAddsKillsToThePlannedFaults) {
  const TempFolder folder;
  const std::string file = folder.Write("s.textproto", WithList(kRules));
  const Scenario edited = Load(EditScenario(
      file, {.keep_faults = false, .kills = {{.vehicle = VehicleId{1}, .at_s = 12.5}}}));
  ASSERT_THAT(edited.faults, SizeIs(2));
  EXPECT_EQ(edited.faults[1].kind, FaultKind::kKill);
  EXPECT_EQ(edited.faults[1].vehicle, VehicleId{1});
  EXPECT_EQ(edited.faults[1].at_s, 12.5);
}

class BothLists : public ::testing::Test {
 protected:
  std::vector<faults::FaultFile> Load(const std::string& own, const std::string& asked) {
    const std::string scenario = folder_.Write("s.textproto", WithList("\n" + own));
    return LoadFaultSources(LoadScenarioWithFaults(scenario, {}).faults,
                            folder_.Write("f.textproto", asked));
  }

  template <typename Call>
  static std::vector<Problem> Refused(const Call& call) {
    try {
      call();
    } catch (const InputError& error) {
      return error.Problems();
    }
    return {};
  }

  TempFolder folder_;
};

constexpr const char* kPause =
    "at { name: \"a\" time_s: 20 kind: \"pause\" vehicle: 1 for_s: 5 }\n";
constexpr const char* kHang = "at { name: \"b\" time_s: 22 kind: \"hang\" vehicle: 1 for_s: 5 }\n";
constexpr const char* kRandomPause =
    "random { name: \"c\" kind: \"pause\" mean_between_s: 1 for_s: 1 vehicle: 1 }\n";

TEST_F(BothLists, AreExpandedAsOne) {
  const auto sources = Load(kPause, kRandomPause);
  ASSERT_THAT(sources, SizeIs(2));
  const faults::Expansion both = ExpandFaults(sources, kMinute, kTwo);
  const faults::Expansion asked = ExpandFaults(std::span(sources).last(1), kMinute, kTwo);
  std::set<std::string> rules;
  for (const faults::Fault& fault : both.schedule) rules.insert(fault.rule);
  EXPECT_THAT(rules, ElementsAre("a", "c"));
  // Those of the one that the other excludes are left out.
  ASSERT_THAT(both.left_out, SizeIs(1));
  ASSERT_THAT(asked.left_out, SizeIs(1));
  EXPECT_GT(both.left_out[0].excluded, asked.left_out[0].excluded);
}

TEST_F(BothLists, MayEachBeAbsent) {
  EXPECT_THAT(LoadFaultSources(std::nullopt, ""), IsEmpty());
  EXPECT_THAT(LoadFaultSources(OwnOf(WithList(kPause)), ""), SizeIs(1));
  EXPECT_THAT(LoadFaultSources(std::nullopt, "calm"), SizeIs(1));
  EXPECT_THAT(Together({}).at, IsEmpty());
}

TEST_F(BothLists, ThatExcludeEachOtherAreRefusedWithBothFiles) {
  const auto sources = Load(kPause, "\n\n" + std::string(kHang));
  const auto problems = Refused([&] { ExpandFaults(sources, kMinute, kTwo); });
  ASSERT_THAT(problems, ElementsAre(Is(3, "b", "exclude each other")));
  EXPECT_THAT(problems[0].file, HasSubstr("f.textproto"));
  EXPECT_THAT(problems[0].message, HasSubstr("a stands in " + folder_.Path() + "/s.textproto"));
  const auto of_one =
      Refused([&] { ExpandFaults(Load("", std::string(kPause) + kHang), kMinute, kTwo); });
  ASSERT_THAT(of_one, SizeIs(1));
  EXPECT_THAT(of_one[0].message, testing::Not(HasSubstr("stands in")));
}

TEST_F(BothLists, WithOneNameAreRefusedAllAtOnce) {
  const std::string asked = std::string("description: \"d\"\n") +
                            "random { name: \"a\" kind: \"loss\" mean_between_s: 9 for_s: 1 }\n"
                            "at { name: \"c\" time_s: 1 kind: \"kill\" vehicle: 1 }\n"
                            "at { name: \"d\" time_s: 1 kind: \"kill\" vehicle: 2 }\n";
  const auto problems = Refused([&] { Load(std::string(kPause) + kRandomPause, asked); });
  ASSERT_THAT(problems, ElementsAre(Is(2, "name", "stands in line 18 of"),
                                    Is(3, "name", "stands in line 19 of")));
  EXPECT_THAT(problems[0].file, HasSubstr("f.textproto"));
  EXPECT_THAT(problems[0].message, HasSubstr("s.textproto"));
  EXPECT_THAT(problems[0].value, "\"a\"");
  EXPECT_THAT(problems[0].remedy, HasSubstr("another name"));
}

TEST_F(BothLists, NameTheFileOfEachRule) {
  const auto sources = Load(kPause, std::string(kHang) + kRandomPause);
  EXPECT_THAT(FileOf(sources, "a"), HasSubstr("s.textproto"));
  EXPECT_THAT(FileOf(sources, "c"), HasSubstr("f.textproto"));
  const std::vector<VehicleId> only_two = {VehicleId{2}};
  const auto problems = Refused([&] { ExpandFaults(sources, kMinute, only_two); });
  ASSERT_THAT(problems, SizeIs(4));  // and that the two exclude each other
  for (const Problem& problem : problems) {
    const bool own = problem.field.starts_with("a");
    EXPECT_THAT(problem.file, HasSubstr(own ? "s.textproto" : "f.textproto")) << problem.field;
  }
}

}  // namespace
}  // namespace giveway

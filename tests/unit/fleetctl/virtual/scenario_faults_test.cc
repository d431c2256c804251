// The faults that a scenario itself has, in virtual runs: by the seed, with those of a fault file,
// and the shipped scenario that has some.
#include <gmock/gmock.h>

#include <set>

#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/fleetctl/virtual/virtual_case.h"
#include "sim_world/virtual/virtual_run.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::set<std::string> RulesOf(const faults::Schedule& schedule) {
  std::set<std::string> rules;
  for (const faults::Fault& fault : schedule) rules.insert(fault.rule);
  return rules;
}

CaseOptions Flaky() { return {.scenario = "flaky_crossing"}; }

class OwnAndFile : public ::testing::Test {
 protected:
  CaseOptions Options(const std::string& own, const std::string& file) const {
    CaseOptions options;
    options.scenario = folder_.Write("s.textproto", kGoodScenario + "faults { " + own + " }");
    if (!file.empty()) options.fault_file = folder_.Write("f.textproto", file);
    return options;
  }

  static std::vector<Problem> Refused(const CaseOptions& options) {
    try {
      CaseMaker maker(options);
    } catch (const InputError& error) {
      return error.Problems();
    }
    return {};
  }

  TempFolder folder_;
};

constexpr const char* kPause = "at { name: \"a\" time_s: 20 kind: \"pause\" vehicle: 1 for_s: 5 }";

TEST_F(OwnAndFile, EachSeedDrawsThoseOfTheScenario) {
  const CaseMaker maker(Flaky());
  EXPECT_TRUE(maker.HasFaults());
  const faults::Schedule once = maker.Make(1).plan.schedule;
  EXPECT_THAT(RulesOf(once), ElementsAre("blind", "hears_late", "hears_none"));
  EXPECT_EQ(maker.Make(1).plan.schedule, once);
  EXPECT_NE(maker.Make(2).plan.schedule, once);
  EXPECT_FALSE(CaseMaker({.scenario = "intersection_yield"}).HasFaults());
}

TEST_F(OwnAndFile, AreOneList) {
  CaseOptions options = Flaky();
  options.fault_file = folder_.Write("f.textproto", kPause);
  EXPECT_THAT(RulesOf(CaseMaker(options).Make(1).plan.schedule),
              ElementsAre("a", "blind", "hears_late", "hears_none"));
}

TEST_F(OwnAndFile, WithOneNameAreRefusedAtTheStart) {
  const auto problems = Refused(Options(kPause, kPause));
  ASSERT_THAT(problems, SizeIs(1));
  EXPECT_THAT(problems[0].file, HasSubstr("f.textproto"));
}

TEST_F(OwnAndFile, ThatCannotBeVirtualAreRefusedTogetherOrLeftOut) {
  constexpr const char* kFull =
      "at { name: \"full\" time_s: 3 kind: \"disk_full\" vehicle: 1 for_s: 1 }";
  constexpr const char* kReader =
      "at { name: \"reader\" time_s: 9 kind: \"log_reader_stops\" vehicle: 1 for_s: 1 }";
  CaseOptions options = Options(std::string(kPause) + kFull, kReader);
  const auto problems = Refused(options);
  ASSERT_THAT(problems, SizeIs(2));
  EXPECT_THAT(problems[0].file, HasSubstr("s.textproto"));
  EXPECT_THAT(problems[1].file, HasSubstr("f.textproto"));
  options.skip_unsupported = true;
  const CaseMaker maker(options);
  EXPECT_THAT(maker.Remark(), HasSubstr("s.textproto: disk_full is left out"));
  EXPECT_THAT(RulesOf(maker.Make(0).plan.schedule), ElementsAre("a"));
}

TEST_F(OwnAndFile, ThatExcludeEachOtherAreRefusedForTheSeed) {
  const CaseMaker maker(
      Options(kPause, "at { name: \"b\" time_s: 22 kind: \"hang\" vehicle: 1 for_s: 5 }"));
  EXPECT_THROW(maker.Make(0), InputError);
}

TEST(FlakyCrossing, PassesWithItsFaultsUnderManySeeds) {
  const CaseMaker maker(Flaky());
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const VirtualCase made = maker.Make(seed);
    const sim::VirtualOutcome outcome = sim::RunVirtually(made.scenario, made.plan);
    EXPECT_TRUE(outcome.held) << seed;
    EXPECT_EQ(outcome.unmet, "") << seed;
    EXPECT_NE(outcome.hash, sim::RunVirtually(made.scenario, {.seed = seed}).hash) << seed;
  }
}

}  // namespace
}  // namespace giveway::fleetctl

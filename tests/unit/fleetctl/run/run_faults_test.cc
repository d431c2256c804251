// What a run carries out of its scenario's faults, the actor of each, and what it refuses.
#include "services/fleetctl/run/run_faults.h"

#include <gmock/gmock.h>

#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/faults/channel.h"
#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

class OfAScenario : public ::testing::Test {
 protected:
  RunFaults Of(const std::string& rules, const std::string& more = "",
               const Impairment& always = {}) {
    const std::string file =
        folder_.Write("s.textproto", kGoodScenario + "faults {\n" + rules + "}\n" + more);
    const auto [scenario, own] = LoadScenarioWithFaults(file, {.seed = 3});
    return FaultsOfRun(own.value(), scenario, std::vector{kOne, kTwo}, always);
  }

  std::vector<Problem> Refused(const std::string& rules, const std::string& more = "") {
    try {
      Of(rules, more);
    } catch (const InputError& error) {
      return error.Problems();
    }
    return {};
  }

  TempFolder folder_;
};

const std::string kAll = R"(at { name: "a" time_s: 12.5 kind: "kill" vehicle: 1 }
at { name: "b" time_s: 4 kind: "loss" vehicle: 2 for_s: 3 probability: 0.5 }
at { name: "c" time_s: 5 kind: "sonar_off" vehicle: 2 for_s: 1 }
random { name: "d" kind: "sonar_stuck" mean_between_s: 4 for_s: 0.5 vehicle: 2 }
)";

TEST_F(OfAScenario, EachIsGivenToItsActor) {
  const RunFaults faults = Of(kAll);
  ASSERT_THAT(faults.kills, SizeIs(1));
  EXPECT_EQ(faults.kills[0].kind, FaultKind::kKill);
  EXPECT_EQ(faults.kills[0].vehicle, kOne);
  EXPECT_EQ(faults.kills[0].at_s, 12.5);
  ASSERT_GT(faults.worlds.size(), 2U);
  for (const faults::Fault& fault : faults.worlds) {
    EXPECT_TRUE(fault.rule == "c" || fault.rule == "d") << fault.rule;
  }
  ASSERT_THAT(faults.heard, SizeIs(2));
  EXPECT_THAT(faults.heard.at(kOne).rules, IsEmpty());
  ASSERT_THAT(faults.heard.at(kTwo).rules, SizeIs(1));
  EXPECT_EQ(faults.heard.at(kTwo).rules[0].loss, 0.5);
  EXPECT_EQ(faults.heard.at(kTwo).rules[0].from_s, 4);
}

TEST_F(OfAScenario, WhatIsHeardAnywayComesFirstAndKeepsItsSeed) {
  const Impairment always{.seed = 9, .rules = {{.loss = 0.1}}};
  const RunFaults faults = Of(kAll, "", always);
  ASSERT_THAT(faults.heard.at(kOne).rules, SizeIs(1));
  ASSERT_THAT(faults.heard.at(kTwo).rules, SizeIs(2));
  EXPECT_EQ(faults.heard.at(kTwo).rules[0].loss, 0.1);
  EXPECT_EQ(faults.heard.at(kTwo).seed, 9U);
  EXPECT_THAT(Of("", "", always).heard, IsEmpty());
}

TEST_F(OfAScenario, WhatOnlyASoakCarriesOutIsRefusedAllAtOnce) {
  const auto problems = Refused(
      "at { name: \"a\" time_s: 20 kind: \"pause\" vehicle: 1 for_s: 1 }\n"
      "at { name: \"b\" time_s: 20 kind: \"loss\" vehicle: 2 for_s: 1 }\n"
      "at { name: \"c\" time_s: 20 kind: \"kill\" target: \"discovery_server\" }\n"
      "random { name: \"d\" kind: \"flooded\" mean_between_s: 9 for_s: 1 }\n"
      "random { name: \"e\" kind: \"kill\" mean_between_s: 9 target: \"discovery_server\" }\n");
  ASSERT_THAT(problems, ElementsAre(Is(18, "a", "only a soak"), Is(20, "c", "only a soak"),
                                    Is(21, "d", "only a soak"), Is(22, "e", "only a soak")));
  EXPECT_EQ(problems[0].value, "pause");
  EXPECT_THAT(problems[0].remedy, HasSubstr("use fleetctl soak"));
  EXPECT_THAT(problems[0].file, HasSubstr("s.textproto"));
}

TEST_F(OfAScenario, AKillIsOfAVehicleOfAClosedFleetInTheFirstDay) {
  const std::string kill = "at { name: \"a\" time_s: 20 kind: \"kill\" vehicle: 1 }\n";
  EXPECT_THAT(Refused(kill), IsEmpty());
  EXPECT_THAT(Refused(kill, "spawn { start { x_m: 8 y_m: 0 heading_deg: 90 } cruise_m_s: 0.3 }"),
              ElementsAre(Is(18, "a", "open fleet")));
  EXPECT_THAT(Refused("at { name: \"a\" time_s: 86401 kind: \"kill\" vehicle: 1 }\n"),
              ElementsAre(Is(18, "a", "first day")));
}

TEST_F(OfAScenario, NothingIsDrawnForARunWithoutAnEnd) {
  const auto problems = Refused(kAll, "duration_s: 0");
  ASSERT_THAT(problems, ElementsAre(Is(21, "d", "without an end")));
  EXPECT_EQ(problems[0].remedy, "give --duration");
}

TEST_F(OfAScenario, WhatNoVehicleHasASensorForIsRefusedOnce) {
  EXPECT_THAT(Refused("at { name: \"a\" time_s: 2 kind: \"pose_fix_lost\" vehicle: 1 for_s: 1 }\n"
                      "at { name: \"a\" nth: 1 time_s: 9 kind: \"pose_fix_lost\" vehicle: 1 "
                      "for_s: 1 }\n"),
              ElementsAre(Is(0, "a", "pose fixes")));
}

}  // namespace
}  // namespace giveway::fleetctl

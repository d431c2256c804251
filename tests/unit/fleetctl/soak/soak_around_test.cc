#include "services/fleetctl/soak/verb/soak_around.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

using ::testing::ElementsAre;

faults::Fault Pause(const char* rule, double at_s, double for_s) {
  faults::Fault fault;
  fault.rule = rule;
  fault.kind = faults::Kind::kPause;
  fault.at_s = at_s;
  fault.for_s = for_s;
  return fault;
}

std::vector<std::string> RulesAround(const faults::Schedule& schedule, double time_s) {
  std::vector<std::string> rules;
  for (const faults::Fault& fault : Around(schedule, {}, time_s)) rules.push_back(fault.rule);
  return rules;
}

TEST(SoakAround, TakesWhatWasOnOrBeganAMinuteBeforeAndALittleAfter) {
  const faults::Schedule schedule{Pause("over", 10, 2), Pause("reaches in", 30, 12),
                                  Pause("in", 90, 1), Pause("just after", 104, 1),
                                  Pause("too late", 106, 1)};
  EXPECT_THAT(RulesAround(schedule, 100), ElementsAre("reaches in", "in", "just after"));
}

TEST(SoakAround, KeepsWhoWasKilledLongBefore) {
  faults::Fault kill = Pause("kill", 10, 0);
  kill.kind = faults::Kind::kKill;
  EXPECT_THAT(RulesAround({kill, Pause("over", 11, 2)}, 180), ElementsAre("kill"));
}

TEST(SoakAround, LeavesTheTimesAsTheyWere) {
  EXPECT_EQ(Around({Pause("in", 90, 1)}, {}, 100).at(0).at_s, 90);
}

// The world's time stands while it is gone: its faults start later than planned.
TEST(SoakAround, GoesByWhenAFaultReallyStarted) {
  faults::Fault off = Pause("sonar", 20, 2);
  off.kind = faults::Kind::kSonarOff;
  SoakFault observed{.rule = "sonar", .at_s = 20};
  EXPECT_TRUE(Around({off}, {observed}, 100).empty());
  observed.observed_s = 95;
  const faults::Schedule around = Around({off}, {observed}, 100);
  ASSERT_EQ(around.size(), 1U);
  EXPECT_EQ(around[0].at_s, 20) << "as planned";
  EXPECT_TRUE(Around({off}, {observed}, 80).empty());
}

}  // namespace
}  // namespace giveway::fleetctl

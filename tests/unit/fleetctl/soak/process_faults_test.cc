// What a vehicle is started with again. What the faults do to processes is in tests/system/soak.sh.
#include "services/fleetctl/soak/process_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;

// A vehicle that has been started with rules, and what it is started with again.
std::vector<std::string> WordsAgain(const std::string& impair_now) {
  FaultTools tools;
  MemberCommand vehicle;
  vehicle.member = MemberOf(VehicleId{1});
  vehicle.child.words = {"giveway-vehicle", "--impair", "@before"};
  vehicle.start_after = std::chrono::hours(1);  // never here
  tools.commands = {vehicle};
  tools.impairment_since = [impair_now](VehicleId, double) { return impair_now; };
  FleetProcesses processes(tools.commands);
  return ProcessFaults(std::move(tools), &processes).CommandNow(vehicle.member).child.words;
}

TEST(ProcessFaults, TheRulesOfOneThatRestartsCountFromThenAndNotFromWhenItHasJoined) {
  EXPECT_THAT(WordsAgain("loss=0.5"), ElementsAre("giveway-vehicle", "--impair", "loss=0.5",
                                                  "--impair-since", testing::Not("")));
}

TEST(ProcessFaults, OneWithoutRulesAnyMoreIsNotImpaired) {
  EXPECT_THAT(WordsAgain(""), ElementsAre("giveway-vehicle"));
}

}  // namespace
}  // namespace giveway::fleetctl

// Which faults are refused where they cannot be carried out.
#include "services/faults/unsupported.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/faults/fault_lists.h"

namespace giveway::faults {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

Fault Named(std::string rule, Fault fault) {
  fault.rule = std::move(rule);
  return fault;
}

TEST(Unsupported, IsToldOnceAKindWithTheRulesThatAskForIt) {
  const Schedule schedule = {Named("b", Of(Kind::kSlow, Vehicle(1), 1, 1)),
                             Named("a", Of(Kind::kSlow, Vehicle(1), 5, 1)),
                             Named("a", Of(Kind::kSlow, Vehicle(2), 6, 1)),
                             Named("c", Of(Kind::kPause, Vehicle(2), 9, 1))};
  const Incapable incapable{.kinds = {{Kind::kSlow, "needs root"}, {Kind::kChurn, "never"}},
                            .targets = {}};
  const auto refused = UnsupportedIn(schedule, incapable);
  ASSERT_THAT(refused, SizeIs(1));
  EXPECT_EQ(refused[0].kind, Kind::kSlow);
  EXPECT_EQ(refused[0].reason, "needs root");
  EXPECT_THAT(refused[0].rules, ElementsAre("a", "b"));
  EXPECT_EQ(refused[0].faults, 3U);
  EXPECT_THAT(Without(schedule, incapable), ElementsAre(schedule[3]));
}

TEST(Unsupported, ATargetMayBeMissing) {
  const Schedule schedule = {Of(Kind::kPause, {Target::What::kDiscoveryServer}, 1, 1),
                             Of(Kind::kPause, Vehicle(2), 9, 1)};
  const Incapable incapable{.kinds = {},
                            .targets = {{Target::What::kDiscoveryServer, "there is none"}}};
  ASSERT_THAT(UnsupportedIn(schedule, incapable), SizeIs(1));
  EXPECT_EQ(UnsupportedIn(schedule, incapable)[0].reason, "there is none");
  EXPECT_THAT(Without(schedule, incapable), ElementsAre(schedule[1]));
  EXPECT_THAT(UnsupportedIn(schedule, {}), IsEmpty());
}

TEST(Unsupported, TheVirtualFleetHasTheFaultsOfItsWorldItsProcessesAndItsRadio) {
  const Incapable incapable = IncapableInVirtualTime();
  const auto can = [&](Kind kind, Target target) {
    return UnsupportedIn({Of(kind, target, 1, 1)}, incapable).empty();
  };
  EXPECT_TRUE(can(Kind::kSonarOff, Vehicle(1)));
  EXPECT_TRUE(can(Kind::kMotorStuck, kAllTarget));
  EXPECT_TRUE(can(Kind::kKill, Vehicle(1)));
  EXPECT_TRUE(can(Kind::kPause, Vehicle(1)));
  EXPECT_FALSE(can(Kind::kPause, kWorldTarget));
  EXPECT_TRUE(can(Kind::kLoss, Vehicle(1)));
  EXPECT_FALSE(can(Kind::kCorrupt, Vehicle(1)));
  EXPECT_FALSE(can(Kind::kFlooded, Vehicle(1)));
}

// The world reported them, and they counted as seen.
TEST(Unsupported, OfAMixedFleetAVehicleWithoutPoseFixesHasNoneToLose) {
  Scenario scenario;
  scenario.vehicles.resize(2);
  scenario.vehicles[0].id = VehicleId{1};
  scenario.vehicles[1].id = VehicleId{2};
  scenario.vehicles[1].profile.pose_fix = {.every_s = 1, .sigma_m = 0.05};
  EXPECT_EQ(WhyTargetLacks(Of(Kind::kPoseFixLost, Vehicle(1), 1, 1), scenario),
            "vehicle 1 has no pose fixes (sensors.pose_fix)");
  EXPECT_EQ(WhyTargetLacks(Of(Kind::kPoseFixLost, Vehicle(2), 1, 1), scenario), "");
  EXPECT_EQ(WhyTargetLacks(Of(Kind::kSonarOff, Vehicle(1), 1, 1), scenario), "");
  EXPECT_EQ(WhyTargetLacks(Of(Kind::kPoseFixLost, kAllTarget, 1, 1), scenario), "");
  EXPECT_EQ(WhyTargetLacks(Of(Kind::kPoseFixLost, Vehicle(9), 1, 1), scenario), "");
}

TEST(Unsupported, FaultsOfFixesAndEncodersNeedAVehicleWithPoseFixes) {
  Scenario scenario;
  scenario.spawns.resize(2);
  const Schedule schedule = {
      Of(Kind::kEncoderWrong, Vehicle(1), 1, 1), Of(Kind::kPoseFixLost, Vehicle(1), 1, 1),
      Of(Kind::kPoseFixWrong, Vehicle(2), 1, 1), Of(Kind::kSonarOff, Vehicle(1), 1, 1)};
  EXPECT_THAT(Without(schedule, IncapableWithSensorsOf(scenario)), ElementsAre(schedule[3]));
  scenario.spawns[1].profile.pose_fix = {.every_s = 1, .sigma_m = 0.05};
  EXPECT_EQ(Without(schedule, IncapableWithSensorsOf(scenario)), schedule);
}

}  // namespace
}  // namespace giveway::faults

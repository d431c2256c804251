// The ten flaws of the printed scripts, in the lecture's order. Each test names the code that fixes
// the flaw; the tenth names the code that keeps it on purpose.
#include <gtest/gtest.h>

#include "tests/support/crossing.h"

namespace giveway {
namespace {

using test::Crossing;
using test::Finish;
using test::ScenarioOf;
using test::VehicleAt;
using Ids = std::set<std::uint32_t>;

class LectureFlaw : public testing::TestWithParam<Behaviour> {};

// Fixed in decision_rules.cc, GiveWay: a dead stop, never the peer's speed.
TEST_P(LectureFlaw, No1TheLoserHaltsInsteadOfCopyingThePeersSpeed) {
  sim::VirtualFleet fleet(Crossing(GetParam(), 0.4, 0.3));
  bool gave_way = false;
  while (fleet.Advance()) {
    const MotorCommand& command = fleet.OutputsOf(1).command;
    if (command.decision.rule != Rule::kGiveWay) continue;
    gave_way = true;
    ASSERT_EQ(command.target, WheelSpeeds{});
  }
  EXPECT_TRUE(gave_way);
}

// Fixed in types/beacon.h, PrecedesByKey: a strict total order.
TEST_P(LectureFlaw, No2EqualSpeedsSendOnlyOneToHalt) {
  const auto outcome = Finish(Crossing(GetParam(), 0.3, 0.3));
  EXPECT_EQ(outcome.halted, Ids{2});
}

// Fixed by comparing the published cruise: halting does not lower it.
TEST_P(LectureFlaw, No3HaltingOnceIsEnough) {
  const auto outcome = Finish(Crossing(GetParam(), 0.4, 0.3));
  EXPECT_EQ(outcome.halts, 1U);
  EXPECT_EQ(outcome.arrived, (Ids{1, 2}));
}

// Fixed in peer_table.h: one entry a vehicle. The third is nearer in the order of beacons, faster,
// and drives away; it must not hide the one that matters.
TEST_P(LectureFlaw, No4AThirdVehiclesBeaconHidesNobody) {
  Scenario scenario = Crossing(GetParam(), 0.4, 0.3);
  scenario.vehicles.push_back(VehicleAt(3, GetParam(), 0.2, {-4, 2}, 180, 1.5));
  const auto outcome = Finish(scenario);
  EXPECT_EQ(outcome.figures.contacts, 0U);
  EXPECT_EQ(outcome.halted, Ids{2});
  EXPECT_EQ(outcome.arrived, (Ids{1, 2, 3}));
}

// Fixed in peer_table.cc, IsFresh. Vehicle 1 waits for 2, which dies: it does not wait for ever.
TEST_P(LectureFlaw, No5ADeadPeerIsNotBelievedForEver) {
  Scenario scenario = Crossing(GetParam(), 0.3, 0.4);
  scenario.faults = {{FaultKind::kKill, VehicleId{2}, std::nullopt, 1.0}};
  const auto outcome = Finish(scenario);
  EXPECT_EQ(outcome.figures.contacts, 0U);
  EXPECT_EQ(outcome.arrived, Ids{1});
}

// Fixed by the priority key: forward cruise, not left squared plus right squared.
TEST(LectureFlaw, No6ASpinningVehicleIsNotAFastOne) {
  const PriorityKey spinning{.speed_bucket = 4, .vehicle = VehicleId{1}};
  const PriorityKey driving{.speed_bucket = 6, .vehicle = VehicleId{2}};
  EXPECT_TRUE(PrecedesByKey(driving, spinning));
}

// Fixed in echoes.cc: an echo counts for a peer only where that peer's body is.
TEST_P(LectureFlaw, No7AWallBesideTheWayTriggersNoRightOfWay) {
  Scenario scenario = ScenarioOf({VehicleAt(1, GetParam(), 0.3, {0, 0}, 0, 4),
                                  VehicleAt(2, GetParam(), 0.4, {0, 2.5}, 180, 3)});
  scenario.walls = {{{1, -0.7}, {3, -0.7}}};
  const auto outcome = Finish(scenario);
  EXPECT_EQ(outcome.halted, Ids{});
  EXPECT_EQ(outcome.arrived, (Ids{1, 2}));
}

// Fixed in steering.cc: the vehicle with priority steers round the one that waits.
TEST_P(LectureFlaw, No8TwoParkedNoseToNoseLeave) {
  Scenario scenario = ScenarioOf({VehicleAt(1, GetParam(), 0.3, {-0.5, 0}, 0, 3),
                                  VehicleAt(2, GetParam(), 0.3, {0.5, 0}, 180, 3)});
  const auto outcome = Finish(scenario);
  EXPECT_EQ(outcome.figures.contacts, 0U);
  EXPECT_EQ(outcome.arrived, (Ids{1, 2}));
}

// Fixed in mover_watch.cc, DetectMovers: unidentified motion within the critical distance halts,
// and the halt names its cause.
TEST_P(LectureFlaw, No9CriticalButDeafHalts) {
  Scenario scenario = Crossing(GetParam(), 0.4, 0.3);
  for (VehicleOptions& vehicle : scenario.vehicles) vehicle.emission_radius_m = 0.6;
  sim::VirtualFleet fleet(scenario);
  bool deaf = false;
  while (fleet.Advance())
    deaf |= fleet.OutputsOf(1).command.decision.rule == Rule::kUnidentifiedMotion;
  EXPECT_TRUE(deaf);
  EXPECT_EQ(fleet.World().Figures().contacts, 0U);
}

INSTANTIATE_TEST_SUITE_P(Settled, LectureFlaw,
                         testing::Values(Behaviour::kCooperative, Behaviour::kLectureYield),
                         [](const auto& test) { return std::string(Name(test.param)); });

// Kept on purpose: vehicle 2a speeds up towards what is exactly ahead. It is the lecture's
// behaviour, and never a default.
TEST(LectureFlawKept, No10DeadAheadTheLecturesAvoiderRams) {
  Scenario scenario = ScenarioOf({VehicleAt(1, Behaviour::kLectureAvoid, 0.195, {-1.5, 0}, 0, 0),
                                  VehicleAt(2, Behaviour::kLectureAvoid, 0.195, {1.5, 0}, 180, 0)});
  scenario.duration_s = 20;
  EXPECT_EQ(Finish(scenario).figures.contacts, 1U);
  EXPECT_NE(VehicleOptions{}.behaviour, Behaviour::kLectureAvoid);
}

}  // namespace
}  // namespace giveway

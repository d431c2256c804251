// A schedule of faults in a virtual run: carried out at its times, to its vehicles, and undone.
#include "sim_world/virtual/virtual_faults.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "services/faults/kind_table.h"
#include "sim_world/virtual/generators.h"
#include "sim_world/virtual/virtual_run.h"
#include "tests/support/crossing.h"

namespace giveway::sim {
namespace {

using faults::Kind;
using What = faults::Target::What;

faults::Fault FaultFor(Kind kind, double at_s, double for_s, std::uint32_t vehicle = 2) {
  return {.rule = std::string(faults::ToString(kind)),
          .at_s = at_s,
          .for_s = for_s,
          .kind = kind,
          .target = {.what = What::kVehicle, .vehicle = VehicleId{vehicle}}};
}

Scenario TwoOnARoad() {
  return test::ScenarioOf({test::VehicleAt(1, Behaviour::kCooperative, 0.4, {0, 0}, 0, 8),
                           test::VehicleAt(2, Behaviour::kCooperative, 0.4, {0, 3}, 0, 8)});
}

VirtualPlan Planned(faults::Schedule schedule) {
  VirtualPlan plan;
  plan.schedule = std::move(schedule);
  return plan;
}

void AdvanceBy(VirtualFleet* fleet, int ticks) {
  for (int i = 0; i < ticks; ++i) ASSERT_TRUE(fleet->Advance());
}

TEST(VirtualFaults, AnEmptyScheduleAndOneOfNothingVirtualChangeNoBit) {
  const Scenario scenario = MakeCrossing({4, 2});
  const std::uint64_t without = RunVirtually(scenario, {}).hash;
  const VirtualPlan plan =
      Planned({FaultFor(Kind::kDiskFull, 1, 5), FaultFor(Kind::kSpoofed, 1, 5)});
  EXPECT_EQ(RunVirtually(scenario, plan).hash, without);
}

// How many of a fault there are to carry out: by processes, by the radio, by the world.
std::size_t CarriedOut(const faults::Fault& fault) {
  const VirtualPlan translated = Translated(Planned({fault}), TwoOnARoad());
  const bool of_world = faults::ActorOf(fault.kind) == faults::Actor::kWorld;
  return translated.faults.size() + translated.radio.rules.size() +
         (of_world ? translated.schedule.size() : 0);
}

TEST(VirtualFaults, EveryKindThatTheTableCallsVirtualIsCarriedOutAndNoOther) {
  for (const faults::KindRow& row : faults::KindTable()) {
    EXPECT_EQ(CarriedOut(FaultFor(row.kind, 1, 1)), row.in_virtual_time ? 1U : 0U) << row.word;
  }
}

TEST(VirtualFaults, OfTheWorldAndOfServersAreNotCarriedOut) {
  faults::Fault fault = FaultFor(Kind::kRestart, 1, 1);
  fault.target = {.what = What::kWorld};
  EXPECT_EQ(CarriedOut(fault), 0U);
  fault.target = {.what = What::kDiscoveryServer};
  EXPECT_EQ(CarriedOut(fault), 0U);
}

TEST(VirtualFaults, AFaultOfAllProcessesIsOneForEach) {
  faults::Fault fault = FaultFor(Kind::kPause, 3, 0.5);
  fault.target = {.what = What::kAll};
  const VirtualPlan translated = Translated(Planned({fault}), TwoOnARoad());
  ASSERT_EQ(translated.faults.size(), 2U);
  EXPECT_EQ(translated.faults[0].vehicle, VehicleId{1});
  EXPECT_EQ(translated.faults[1].vehicle, VehicleId{2});
}

TEST(VirtualFaults, AHungVehicleAnswersNothingForItsTime) {
  VirtualFleet fleet(TwoOnARoad(), Planned({FaultFor(Kind::kHang, 4, 0.5)}));
  AdvanceBy(&fleet, 79);
  EXPECT_TRUE(fleet.Answered(1));
  for (int i = 0; i < 10; ++i) {
    AdvanceBy(&fleet, 1);
    EXPECT_FALSE(fleet.Answered(1)) << i;
    EXPECT_TRUE(fleet.Answered(0)) << i;
  }
  AdvanceBy(&fleet, 1);
  EXPECT_TRUE(fleet.Answered(1));
}

// A soak of rush_hour: hung until 5183.191 s, paused from 5183.208 s on, both in one tick of 50 ms.
// And one whose time, in whole ticks, is longer than the gap to the next.
TEST(VirtualFaults, APauseRightAfterAnotherIsCarriedOut) {
  for (const double second_at_s : {4.49, 4.508}) {
    const faults::Fault first = FaultFor(Kind::kHang, 4.01, 0.46);
    const faults::Fault second = FaultFor(Kind::kPause, second_at_s, 0.5);
    VirtualFleet fleet(TwoOnARoad(), Planned({first, second}));
    AdvanceBy(&fleet, 99);
    EXPECT_FALSE(fleet.Answered(1)) << second_at_s;
    AdvanceBy(&fleet, 3);
    EXPECT_TRUE(fleet.Answered(1)) << second_at_s;
  }
}

TEST(VirtualFaults, ASlowVehicleAnswersItsShareOfTicks) {
  faults::Fault fault = FaultFor(Kind::kSlow, 2, 5);
  fault.parameters.share = 0.3;
  VirtualFleet fleet(TwoOnARoad(), Planned({fault}));
  AdvanceBy(&fleet, 39);
  int answered = 0;
  for (int i = 0; i < 100; ++i) {
    AdvanceBy(&fleet, 1);
    answered += fleet.Answered(1) ? 1 : 0;
  }
  EXPECT_NEAR(answered, 30, 1);
  for (int i = 0; i < 20; ++i) {
    AdvanceBy(&fleet, 1);
    EXPECT_TRUE(fleet.Answered(1));
  }
  fleet.Finish();
  EXPECT_EQ(fleet.World().EndReason(), "all_arrived");
}

TEST(VirtualFaults, AKilledVehicleIsNotWaitedFor) {
  const VirtualOutcome outcome = RunVirtually(TwoOnARoad(), Planned({FaultFor(Kind::kKill, 3, 0)}));
  EXPECT_TRUE(outcome.held);
  EXPECT_EQ(outcome.delays_s.size(), 1U);
}

// Regression: one whose body was removed came back right in front of a vehicle that drove past its
// start place, which could not stop any more and was blamed.
TEST(VirtualFaults, AVehicleDoesNotComeBackWhereAnotherCannotStopForIt) {
  Scenario scenario =
      test::ScenarioOf({test::VehicleAt(1, Behaviour::kCooperative, 0.4, {-12, 0}, 0, 24),
                        test::VehicleAt(2, Behaviour::kCooperative, 1.0, {3, 0}, 90, 19)});
  scenario.duration_s = 120;
  scenario.remove_after_s = 1;
  for (int i = 0; i < 40; ++i) {
    const double for_s = 21.5 + 0.05 * i;
    const auto outcome = RunVirtually(scenario, Planned({FaultFor(Kind::kRestart, 14, for_s)}));
    EXPECT_EQ(outcome.contacts, 0U) << for_s;
    EXPECT_TRUE(outcome.held) << for_s;
  }
}

// Longer than the world waits for a command: it is taken back nevertheless, where it stands.
TEST(VirtualFaults, AVehiclePausedForSecondsIsTakenBack) {
  VirtualFleet fleet(TwoOnARoad(), Planned({FaultFor(Kind::kPause, 4, 3)}));
  fleet.Finish();
  EXPECT_EQ(fleet.World().EndReason(), "all_arrived");
  const auto count = [&](EventKind kind) {
    return std::ranges::count(fleet.History(), kind, &WorldEvent::kind);
  };
  EXPECT_EQ(count(EventKind::kSilent), 1);
  EXPECT_EQ(count(EventKind::kJoined), 1);
  EXPECT_EQ(count(EventKind::kRemoved), 0);
  EXPECT_EQ(count(EventKind::kArrived), 2);
}

// Away for longer than its body stays: it starts again at its start place.
TEST(VirtualFaults, ARestartThatOutlastsItsBodyBeginsAtTheStart) {
  VirtualFleet fleet(TwoOnARoad(), Planned({FaultFor(Kind::kRestart, 6, 10)}));
  AdvanceBy(&fleet, 319);
  EXPECT_FALSE(fleet.World().Truths()[1].present);
  AdvanceBy(&fleet, 2);
  EXPECT_TRUE(fleet.World().Truths()[1].present);
  EXPECT_NEAR(fleet.World().Truths()[1].world_from_body.position_world.x, 0, 0.01);
  fleet.Finish();
  EXPECT_EQ(fleet.World().EndReason(), "all_arrived");
  EXPECT_EQ(std::ranges::count(fleet.History(), EventKind::kArrived, &WorldEvent::kind), 2);
}

TEST(VirtualFaults, APartitionIsHeardByNobodyAndEnds) {
  VirtualFleet fleet(TwoOnARoad(), Planned({FaultFor(Kind::kPartition, 2, 1)}));
  const auto heard = [&] {
    const std::uint32_t before = fleet.Brain(0).State().counters.beacons.taken;
    AdvanceBy(&fleet, 1);
    return fleet.Brain(0).State().counters.beacons.taken - before;
  };
  AdvanceBy(&fleet, 39);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(heard(), 0U) << i;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(heard(), 1U) << i;
}

TEST(VirtualFaults, OfTheWorldAreInTheHistory) {
  VirtualFleet fleet(TwoOnARoad(), Planned({FaultFor(Kind::kSonarStuck, 2, 1)}));
  fleet.Finish();
  EXPECT_EQ(std::ranges::count(fleet.History(), EventKind::kFaultBegan, &WorldEvent::kind), 1);
  EXPECT_EQ(std::ranges::count(fleet.History(), EventKind::kFaultOver, &WorldEvent::kind), 1);
}

// Every kind there is at once, and twice the same hash.
TEST(VirtualFaults, OneScheduleTwiceGivesOneHash) {
  faults::Schedule schedule;
  double at_s = 1;
  for (const faults::KindRow& row : faults::KindTable()) {
    schedule.push_back(FaultFor(row.kind, at_s, row.takes_time ? 2 : 0, 1 + schedule.size() % 4));
    if (row.kind == Kind::kKill) schedule.back().at_s = 25;
    at_s += 0.5;
  }
  const Scenario scenario = MakeCrossing({4, 2});
  const VirtualPlan plan = Planned(schedule);
  const std::uint64_t once = RunVirtually(scenario, plan).hash;
  EXPECT_EQ(RunVirtually(scenario, plan).hash, once);
  EXPECT_NE(RunVirtually(scenario, {}).hash, once);
  VirtualPlan other = plan;
  other.seed = 9;
  EXPECT_NE(RunVirtually(scenario, other).hash, once);
}

}  // namespace
}  // namespace giveway::sim

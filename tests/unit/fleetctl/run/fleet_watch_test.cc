#include "services/fleetctl/run/fleet_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

Scenario TwoVehicles() {
  Scenario scenario;
  scenario.name = "crossing";
  scenario.seed = 11;
  scenario.vehicles.resize(2);
  scenario.vehicles[0].id = kOne;
  scenario.vehicles[1].id = kTwo;
  return scenario;
}

WorldEvent Event(EventKind kind, VehicleId vehicle = kNoVehicle) {
  WorldEvent event;
  event.kind = kind;
  event.vehicle = vehicle;
  return event;
}

link::Observed Events(std::vector<WorldEvent> events) {
  link::Observed observed;
  observed.events = std::move(events);
  return observed;
}

VehicleStatus Status(VehicleId vehicle, std::uint32_t sent, bool final) {
  VehicleStatus status;
  status.vehicle = vehicle;
  status.beacons.sent = sent;
  status.beacons.accepted = sent / 2;
  status.qos.deadline_missed = 1;
  status.qos.liveliness_lost = 2;
  status.trust = {1, 2, 3, 4, 5};
  status.final = final;
  return status;
}

RunFigures PassedFigures() {
  RunFigures figures;
  figures.passed = true;
  figures.reason = "expectations_met";
  figures.min_separation_m = 0.42;
  figures.tick_overruns = 3;
  figures.state_hash = 0xabc;
  return figures;
}

class FleetWatchTest : public testing::Test {
 protected:
  Scenario scenario_ = TwoVehicles();
  FleetWatch watch_{scenario_, false};
};

TEST_F(FleetWatchTest, NothingHeardIsAFailedRunWithoutFigures) {
  const Report report = watch_.MakeReport(Overruled{Verdict::kFailed, "no_figures"});
  EXPECT_EQ(report.verdict, Verdict::kFailed);
  EXPECT_EQ(report.reason, "no_figures");
  EXPECT_EQ(report.scenario, "crossing");
  EXPECT_EQ(report.seed, 11U);
  EXPECT_FALSE(report.min_separation_m.has_value());
  EXPECT_EQ(report.state_hash, "");
}

TEST_F(FleetWatchTest, VerdictAndFiguresAreTheWorlds) {
  link::Observed observed;
  observed.figures = PassedFigures();
  watch_.Fold(observed);
  const Report report = watch_.MakeReport(std::nullopt);
  EXPECT_EQ(report.verdict, Verdict::kPassed);
  EXPECT_EQ(report.reason, "expectations_met");
  EXPECT_EQ(report.min_separation_m, 0.42);
  EXPECT_EQ(report.tick_overruns, 3U);
  EXPECT_EQ(report.state_hash, "0000000000000abc");
}

TEST_F(FleetWatchTest, DeathOverrulesAWorldThatSaysPassed) {
  link::Observed observed;
  observed.figures = PassedFigures();
  watch_.Fold(observed);
  const Report report = watch_.MakeReport(Overruled{Verdict::kFailed, "process_died"});
  EXPECT_EQ(report.verdict, Verdict::kFailed);
  EXPECT_EQ(report.reason, "process_died");
  EXPECT_EQ(report.min_separation_m, 0.42);
}

TEST_F(FleetWatchTest, APictureShowsTheReportsVerdictWhereTheWorldSaysPassed) {
  WorldEvent passed = Event(EventKind::kVerdict);
  passed.value = 1;
  watch_.Fold(Events({passed}));
  Report report = watch_.MakeReport(std::nullopt);
  report.verdict = Verdict::kFailed;
  report.reason = "invariant_broken: yielding";
  EXPECT_THAT(watch_.DrawPicture(report), testing::HasSubstr(">failed<"));
  EXPECT_THAT(watch_.DrawPicture(report), testing::HasSubstr(">invariant broken: yielding<"));
}

TEST_F(FleetWatchTest, HaltedAndArrivedAreSetsInOrder) {
  watch_.Fold(Events({Event(EventKind::kHalted, kTwo), Event(EventKind::kResumed, kTwo),
                      Event(EventKind::kHalted, kTwo), Event(EventKind::kArrived, kTwo),
                      Event(EventKind::kArrived, kOne)}));
  const Report report = watch_.MakeReport(std::nullopt);
  EXPECT_THAT(report.halted, ElementsAre(kTwo));
  EXPECT_THAT(report.arrived, ElementsAre(kOne, kTwo));
}

TEST_F(FleetWatchTest, ContactsAreCountedEvenIfTheWorldDiesBeforeItsFigures) {
  watch_.Fold(Events({Event(EventKind::kContact, kOne), Event(EventKind::kContact, kTwo)}));
  EXPECT_EQ(watch_.MakeReport(Overruled{Verdict::kFailed, "process_died"}).contacts, 2U);
}

TEST_F(FleetWatchTest, NewestStatusOfEachVehicleIsSummed) {
  link::Observed observed;
  observed.statuses = {Status(kOne, 10, false), Status(kOne, 40, true), Status(kTwo, 20, true)};
  watch_.Fold(observed);
  const Report report = watch_.MakeReport(std::nullopt);
  EXPECT_EQ(report.beacons_sent, 60U);
  EXPECT_EQ(report.beacons_received, 30U);
  EXPECT_EQ(report.deadline_missed, 2U);
  EXPECT_EQ(report.liveliness_lost, 4U);
  EXPECT_EQ(report.trust.beacon_without_echo, 2U);
  EXPECT_EQ(report.trust.echo_without_beacon, 4U);
  EXPECT_EQ(report.trust.halted_but_closing, 6U);
  EXPECT_EQ(report.trust.jumps, 8U);
  EXPECT_EQ(report.trust.impossible_speeds, 10U);
  EXPECT_EQ(report.trust.Total(), 30U);
}

TEST_F(FleetWatchTest, EveryLifeOfARestartedVehicleCounts) {
  link::Observed observed;
  observed.statuses = {Status(kOne, 10, false), Status(kOne, 40, false), Status(kOne, 6, false),
                       Status(kOne, 8, true),   Status(kOne, 20, false), Status(kTwo, 20, true)};
  watch_.Fold(observed);
  const Report report = watch_.MakeReport(std::nullopt);
  EXPECT_EQ(report.beacons_sent, 40U + 8U + 20U + 20U);
  EXPECT_EQ(report.beacons_received, 44U);
  EXPECT_EQ(report.deadline_missed, 4U);
  EXPECT_EQ(report.trust.beacon_without_echo, 4U);
}

TEST_F(FleetWatchTest, SumsOfAFleetMayPassThirtyTwoBits) {
  link::Observed observed;
  observed.statuses = {Status(kOne, 3'000'000'000, true), Status(kTwo, 3'000'000'000, true)};
  watch_.Fold(observed);
  EXPECT_EQ(watch_.MakeReport(std::nullopt).beacons_sent, 6'000'000'000U);
}

TEST_F(FleetWatchTest, LastSeenStatusOfAKilledVehicleCountsAndIsNotWaitedFor) {
  link::Observed observed = Events({Event(EventKind::kFaultDue, kTwo)});
  observed.statuses = {Status(kOne, 40, true), Status(kTwo, 20, false)};
  watch_.Fold(observed);
  EXPECT_TRUE(watch_.HasAllFinalStatuses());
  EXPECT_EQ(watch_.MakeReport(std::nullopt).beacons_sent, 60U);
}

TEST_F(FleetWatchTest, FinalStatusOfEveryLivingVehicleIsWaitedFor) {
  link::Observed observed;
  observed.statuses = {Status(kOne, 40, true), Status(kTwo, 20, false)};
  watch_.Fold(observed);
  EXPECT_FALSE(watch_.HasAllFinalStatuses());
}

TEST_F(FleetWatchTest, TheKilledAndTheUnheardAreSilent) {
  watch_.Fold(Events({Event(EventKind::kFaultDue, kTwo), Event(EventKind::kSilent, kOne)}));
  EXPECT_THAT(watch_.Silent(), ElementsAre(kOne, kTwo));
}

TEST_F(FleetWatchTest, DueKillIsHandedOutOnce) {
  watch_.Fold(Events({Event(EventKind::kFaultDue, kTwo)}));
  EXPECT_THAT(watch_.TakeDueKills(), ElementsAre(kTwo));
  EXPECT_THAT(watch_.TakeDueKills(), IsEmpty());
}

TEST_F(FleetWatchTest, EndIsKnownFromTheEventOrFromTheRoster) {
  EXPECT_FALSE(watch_.HasEnded());
  link::Observed roster;
  roster.roster.resize(1);
  roster.roster[0].run_state = RunState::kEnded;
  watch_.Fold(roster);
  EXPECT_TRUE(watch_.HasEnded());

  FleetWatch by_event(scenario_, false);
  by_event.Fold(Events({Event(EventKind::kStarted)}));
  EXPECT_TRUE(by_event.HasStarted());
  EXPECT_FALSE(by_event.HasEnded());
  by_event.Fold(Events({Event(EventKind::kEnded)}));
  EXPECT_TRUE(by_event.HasEnded());
}

TEST_F(FleetWatchTest, TimeOfTheRunNeverRunsBackwards) {
  link::Observed observed;
  observed.truths.resize(2);
  observed.truths[0].time_s = 3;
  observed.truths[1].time_s = 2.5;
  watch_.Fold(observed);
  EXPECT_EQ(watch_.TimeSeconds(), 3);
}

TEST(FleetWatchOfAnOpenFleet, KnowsWhoIsInItNow) {
  Scenario scenario = TwoVehicles();
  scenario.spawns.resize(1);
  FleetWatch watch(scenario, false);
  const VehicleId kThree{3};
  EXPECT_EQ(watch.Vehicles(), (std::set{kOne, kTwo}));
  watch.Fold(Events({Event(EventKind::kJoined, kThree), Event(EventKind::kSilent, kThree)}));
  EXPECT_TRUE(watch.Vehicles().contains(kThree));
  EXPECT_TRUE(watch.Silent().contains(kThree));
  watch.Fold(Events({Event(EventKind::kJoined, kThree)}));  // it is back
  EXPECT_FALSE(watch.Silent().contains(kThree));
  watch.Fold(Events({Event(EventKind::kLeft, kThree)}));
  EXPECT_FALSE(watch.Vehicles().contains(kThree));
  link::Observed last_words;
  last_words.statuses.push_back({.vehicle = kThree, .final = true});
  watch.Fold(last_words);
  EXPECT_FALSE(watch.Vehicles().contains(kThree));
}

TEST(FleetWatchOfAnOpenFleet, AFaultOfASignalKillsNobody) {
  FleetWatch watch(TwoVehicles(), false);
  watch.Fold(Events({Event(EventKind::kFaultDue)}));
  EXPECT_TRUE(watch.TakeDueKills().empty());
}

// Issue 21, number 11: a picture of a long run kept every point, 1.5 GB a day of eight vehicles.
TEST(FleetWatch, ThinsTheWaysOfALongRunAndKeepsTheirLastPoints) {
  const Scenario scenario = TwoVehicles();
  FleetWatch watch(scenario, true);
  for (std::uint32_t tick = 1; tick <= 50'000; ++tick) {
    link::Observed observed;
    for (const VehicleId vehicle : {kOne, kTwo}) {
      Truth truth;
      truth.vehicle = vehicle;
      truth.time_s = tick * 0.05;
      truth.present = true;
      truth.world_from_body.position_world = {tick * 0.001, static_cast<double>(Number(vehicle))};
      observed.truths.push_back(truth);
    }
    watch.Fold(observed);
  }
  EXPECT_LE(watch.KeptPoints(), 2U * 8192U);
  EXPECT_GE(watch.KeptPoints(), 2U * 4096U);
  EXPECT_EQ(watch.LastPoint(kTwo)->position_world.x, 50.0);
}

}  // namespace
}  // namespace giveway::fleetctl

// Which violations an observer of a real run reports, and which it must not.
#include "services/fleetctl/run/invariant_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/seen_fleet.h"

namespace giveway::fleetctl {
namespace {

using sim::Invariant;
using testing::HasSubstr;
using testing::IsEmpty;

using InvariantWatchTest = SeenFleet;

TEST_F(InvariantWatchTest, JudgesEveryTickOfARunInWhichNothingIsWrong) {
  Observe(50);
  Halt(two_, one_);
  Observe(50);
  for (Car& car : cars_) {
    car.truth.arrived = true;
    car.truth.forward_m_s = 0;
  }
  Observe();
  watch_->Finish(true);
  EXPECT_TRUE(Held());
  EXPECT_EQ(watch_->TicksJudged(), 101U);
  EXPECT_EQ(watch_->TicksUnseen(), 0U);
}

TEST_F(InvariantWatchTest, NothingIsJudgedBeforeTheStartOrAfterTheEnd) {
  for (Car& car : cars_) car.truth.time_s = -1;
  link::Observed waiting;
  waiting.truths = {cars_[0].truth, cars_[1].truth};
  watch_->Fold(waiting);
  Observe(20);
  Observe({{.kind = EventKind::kEnded}});
  Observe(20);
  watch_->Finish(true);
  EXPECT_EQ(watch_->TicksJudged(), 21U);
}

// A crossing of real processes: all had arrived, but the truth of the last tick was lost.
TEST_F(InvariantWatchTest, ArrivalIsJudgedByTheLastTickOrNotAtAll) {
  Observe(50);
  for (Car& car : cars_) car.seen = false;
  Observe({{.kind = EventKind::kEnded}});
  watch_->Finish(true);
  EXPECT_EQ(Count(Invariant::kArrival), 0U);
  Begin();
  for (Car& car : cars_) car.seen = true;
  Observe(50);
  Observe({{.kind = EventKind::kEnded}});
  watch_->Finish(true);
  EXPECT_EQ(Count(Invariant::kArrival), 2U);
}

TEST_F(InvariantWatchTest, AContactBreaksARunThatHadPassed) {
  Observe(5);
  Observe({{.kind = EventKind::kContact, .vehicle = one_, .other = two_}});
  Observe(5);
  watch_->Finish(false);
  Report report;
  report.verdict = Verdict::kPassed;
  watch_->AddTo(&report);
  EXPECT_EQ(report.verdict, Verdict::kFailed);
  EXPECT_EQ(report.reason, "invariant_broken: contact");
  ASSERT_EQ(report.first_violations.size(), 1U);
  EXPECT_EQ(report.first_violations[0].tick, Tick{6});
  EXPECT_THAT(ToJson(report), HasSubstr("\"violations\":{\"contact\":1,\"stale_motion\":0"));
  EXPECT_THAT(ToTable(report, 80), HasSubstr("first contact at tick 6"));
}

TEST_F(InvariantWatchTest, AContactAfterTheWorldCameBackBreaksTheRun) {
  Observe(30);
  RestartWorld(3);
  Observe(20);
  Observe({{.kind = EventKind::kContact, .vehicle = one_, .other = two_}});
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kContact), 1U);
}

TEST_F(InvariantWatchTest, NothingIsWrongInTheTicksThatAWorldRunsTwice) {
  Observe(30);
  RestartWorld(4);
  Observe(30);
  watch_->Finish(false);
  EXPECT_TRUE(Held());
  EXPECT_EQ(watch_->TicksJudged(), 56U);
  EXPECT_EQ(watch_->TicksUnseen(), 0U);
}

TEST_F(InvariantWatchTest, AWorldThatCameBackIsJudgedFromItsFirstStepOn) {
  Observe(30);
  RestartWorld(0);
  for (int i = 0; i < 10; ++i) {  // it waits for its vehicles
    Of(one_).truth.tick = Of(two_).truth.tick = Tick{++tick_};
    link::Observed waiting;
    waiting.truths = {Of(one_).truth, Of(two_).truth};
    watch_->Fold(waiting);
  }
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(watch_->TicksJudged(), 50U);
}

TEST_F(InvariantWatchTest, WhatAWorldBeforeSaidLateIsNotHeard) {
  Observe(30);
  link::Observed late;
  late.truths = {Of(one_).truth};
  RestartWorld(0);
  Observe(20);
  watch_->Fold(late);
  Observe({{.kind = EventKind::kContact, .vehicle = one_, .other = two_}});
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kContact), 1U);
  EXPECT_EQ(watch_->TicksJudged(), 70U);  // by its first truth it may still wait
}

TEST_F(InvariantWatchTest, TicksThatWereNotSeenDoNotMakeAVehicleStuck) {
  Observe(20);
  Of(one_).seen = false;
  Observe(2000);
  Of(one_).seen = true;
  Observe(60);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kProgress), 0U);
}

TEST_F(InvariantWatchTest, WhoDrivesPastARedLightBreaksTheRun) {
  scenario_.signals = {{.id = SignalId{1},
                        .line_from_world = {0, -1},
                        .line_to_world = {0, 1},
                        .green_s = 0,
                        .yellow_s = 0,
                        .red_s = 100}};
  Begin();
  for (int i = 0; i < 80; ++i) {
    Of(one_).truth.world_from_body.position_world = {-0.6 + 0.015 * i, 0};
    Of(two_).truth.world_from_body.position_world = {-0.6, 5 + 0.015 * i};
    Observe();
  }
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kRedLight), 1U);
  EXPECT_EQ(watch_->Judged().First()[0].vehicle, one_);
}

TEST_F(InvariantWatchTest, WhoIsWedgedBreaksTheRunWhateverItIsExpectedTo) {
  scenario_.expect.arrived.clear();
  scenario_.vehicles[0].goal.at_world = scenario_.vehicles[1].goal.at_world = {9, 0};
  Begin();
  Decide(two_, Rule::kSteerRound, one_);
  Of(one_).truth.arrived = true;
  Of(one_).truth.forward_m_s = 0;
  Observe(62 * 20 + 20);
  watch_->Finish(true);
  EXPECT_EQ(Count(Invariant::kProgress), 1U);
  EXPECT_EQ(Count(Invariant::kArrival), 0U);
  Report report;
  report.verdict = Verdict::kPassed;
  watch_->AddTo(&report);
  EXPECT_EQ(report.reason, "invariant_broken: progress");
}

TEST_F(InvariantWatchTest, AVerdictThatWasNotPassedKeepsItsReason) {
  Observe({{.kind = EventKind::kContact, .vehicle = one_, .other = two_}});
  watch_->Finish(false);
  Report report;
  report.verdict = Verdict::kFailed;
  report.reason = "interrupted";
  watch_->AddTo(&report);
  EXPECT_EQ(report.reason, "interrupted");
  EXPECT_EQ(report.violations[0].count, 1U);
}

TEST_F(InvariantWatchTest, ExpectedContactsAreTheJudgesToCount) {
  scenario_.expect.contacts = 1;
  Begin();
  Observe({{.kind = EventKind::kContact, .vehicle = one_, .other = two_}});
  watch_->Finish(false);
  EXPECT_TRUE(Held());
}

TEST_F(InvariantWatchTest, GivingWayToOneThatComesLaterIsFound) {
  Observe(20);
  Halt(one_, two_);  // but it comes first
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kOrder), 1U);
}

TEST_F(InvariantWatchTest, WhomItGivesWayToIsNotGuessed) {
  Observe(20);
  Of(one_).status_comes = false;  // its last one says that it cruises
  Halt(one_, two_);
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kOrder), 0U);
}

TEST_F(InvariantWatchTest, ACircleThatLastsIsFoundAndAMomentIsNot) {
  Observe(20);
  Halt(two_, one_);
  Halt(one_, two_);
  Observe(5);
  Drive(one_, 0.1);
  Decide(one_, Rule::kCruise);
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kWaitCycle), 0U);
  Halt(one_, two_);
  Observe(40);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kWaitCycle), 1U);
  EXPECT_EQ(Count(Invariant::kAllHalted), 1U);
}

TEST_F(InvariantWatchTest, BrakingWithoutScansIsAllowedAndDrivingOnIsNot) {
  for (const bool brakes : {true, false}) {
    Begin();
    tick_ = 0;
    Drive(one_, 0.3);
    Decide(one_, Rule::kCruise);
    Of(one_).scans = true;
    Observe(20);
    Of(one_).scans = false;  // it speaks on, by the last scan it has
    Observe(3);              // until it knows
    Decide(one_, Rule::kRangesStale);
    double speed_m_s = 0.3;
    for (int i = 0; i < 40; ++i) {
      Observe();
      if (brakes) speed_m_s = std::max(0.0, speed_m_s - 0.6 * kTick_s);
      Drive(one_, speed_m_s);
    }
    watch_->Finish(false);
    EXPECT_EQ(Count(Invariant::kStaleMotion), brakes ? 0U : 1U);
  }
}

TEST_F(InvariantWatchTest, AVehicleThatWasSilentAndDroveOnIsFound) {
  Observe(20);
  Of(one_).speaks = Of(one_).scans = false;
  Observe(30);
  Of(one_).speaks = Of(one_).scans = true;
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kStaleMotion), 1U);
}

TEST_F(InvariantWatchTest, WhatTheObserverMissedIsNotHeldAgainstTheVehicle) {
  Observe(20);
  Of(one_).heard = false;
  Observe(30);
  Of(one_).heard = true;
  Observe(20);
  watch_->Finish(false);
  EXPECT_TRUE(Held());
  EXPECT_EQ(watch_->TicksUnseen(), 30U - VehicleObservation::kHeldTicks);
  EXPECT_EQ(watch_->TicksJudged() + watch_->TicksUnseen(), 70U);
}

TEST_F(InvariantWatchTest, ATickWithoutATruthIsLeftOut) {
  Observe(20);
  Of(two_).seen = false;
  Observe();
  Of(two_).seen = true;
  Observe(20);
  watch_->Finish(false);
  EXPECT_TRUE(Held());
  EXPECT_EQ(watch_->TicksUnseen(), 1U);
}

TEST_F(InvariantWatchTest, AContactOfATickThatWasNotSeenIsStillTold) {
  Observe(20);
  Of(two_).seen = false;
  Observe({{.kind = EventKind::kContact, .vehicle = one_, .other = two_}});
  Of(two_).seen = true;
  Observe(20);
  EXPECT_EQ(Count(Invariant::kContact), 1U);
}

TEST_F(InvariantWatchTest, WhoDiedNeedNotArriveAndIsJudgedNoLonger) {
  Observe(20);
  Of(two_).speaks = false;
  Observe({{.kind = EventKind::kFaultDue, .vehicle = two_}});
  for (double speed_m_s = 0.3; speed_m_s > 0; speed_m_s -= 0.6 * kTick_s) {
    Observe();
    if (tick_ > 25) Drive(two_, speed_m_s);  // the world's watchdog stops it
    if (tick_ <= 25) speed_m_s = 0.3;
  }
  Drive(two_, 0);
  Observe(20);
  Of(two_).truth.present = false;
  Of(one_).truth.arrived = true;
  Of(one_).truth.forward_m_s = 0;
  Observe(20);
  watch_->Finish(true);
  EXPECT_TRUE(Held());
  EXPECT_EQ(watch_->TicksUnseen(), 0U);
}

TEST_F(InvariantWatchTest, WhoIsExpectedAndDoesNotArriveIsNamed) {
  Of(one_).truth.arrived = true;
  Of(one_).truth.forward_m_s = 0;
  Observe(20);
  watch_->Finish(true);
  EXPECT_EQ(Count(Invariant::kArrival), 1U);
  scenario_.expect.arrived = {one_};
  Begin();
  tick_ = 0;
  Observe(20);
  watch_->Finish(true);
  EXPECT_TRUE(Held());
}

TEST_F(InvariantWatchTest, BeaconsNobodyShouldBelieveAreNotBelieved) {
  Observe(20);
  link::Observed forged;
  Beacon lie = cars_[0].beacon;
  lie.seq += 1;
  lie.rule = Rule::kRangesStale;
  forged.beacons = {{.beacon = lie, .crc_valid = true, .name_valid = false},
                    {.beacon = lie, .crc_valid = false, .name_valid = true}};
  lie.world_epoch = WorldEpoch{6};
  forged.beacons.push_back({.beacon = lie, .crc_valid = true, .name_valid = true});
  lie.vehicle = VehicleId{9};
  forged.beacons.push_back({.beacon = lie, .crc_valid = true, .name_valid = true});
  watch_->Fold(forged);
  Observe(30);
  watch_->Finish(false);
  EXPECT_TRUE(Held());
  EXPECT_EQ(watch_->TicksUnseen(), 0U);
}

TEST_F(InvariantWatchTest, AnOpenFleetsNewcomersAreJudgedFromTheirRosterEntryOn) {
  BeginOpen();
  Of(two_).seen = Of(two_).heard = Of(two_).status_comes = false;
  Observe(20);
  const link::Observed joined = TwoIsAccepted();
  watch_->Fold(joined);
  watch_->Fold(joined);  // repeated answer
  Of(two_).seen = Of(two_).heard = Of(two_).status_comes = true;
  Observe({{.kind = EventKind::kJoined, .vehicle = two_}});
  Observe(30);
  EXPECT_TRUE(Held());
  Halt(one_, two_);
  Observe(30);
  EXPECT_EQ(Count(Invariant::kOrder), 1U);
  Observe({{.kind = EventKind::kLeft, .vehicle = two_}});
  Of(two_).truth.present = false;
  Of(two_).speaks = false;
  Decide(one_, Rule::kCruise);
  Observe(30);
  watch_->Finish(true);
  EXPECT_EQ(Count(Invariant::kArrival), 0U);
  EXPECT_EQ(watch_->TicksUnseen(), 0U);
}

TEST_F(InvariantWatchTest, TheOthersAreJudgedAfterTheWorldHasForgottenOneThatLeft) {
  BeginOpen();
  const link::Observed joined = TwoIsAccepted();
  watch_->Fold(joined);
  Observe({{.kind = EventKind::kJoined, .vehicle = two_}});
  Observe(20);
  Observe({{.kind = EventKind::kSilent, .vehicle = two_}});
  Of(two_).speaks = false;
  Observe(20);
  Of(two_).truth.present = false;
  Observe(20);
  Of(two_).seen = false;
  Observe(300);
  EXPECT_EQ(watch_->TicksUnseen(), 0U);
  EXPECT_EQ(watch_->Vehicles(), 1U);
  watch_->Fold(joined);  // and it comes again
  Of(two_).seen = Of(two_).speaks = Of(two_).truth.present = true;
  Observe({{.kind = EventKind::kJoined, .vehicle = two_}});
  Observe(30);
  Halt(one_, two_);
  Observe(30);
  EXPECT_EQ(Count(Invariant::kOrder), 1U);
  EXPECT_EQ(watch_->TicksUnseen(), 0U);
}

TEST_F(InvariantWatchTest, OneThatIsBackSoonAfterItWasTakenAwayIsJudged) {
  BeginOpen();
  const link::Observed joined = TwoIsAccepted();
  watch_->Fold(joined);
  Observe({{.kind = EventKind::kJoined, .vehicle = two_}});
  Observe(20);
  Of(two_).truth.present = false;
  Observe({{.kind = EventKind::kLeft, .vehicle = two_}});
  Of(two_).speaks = false;
  Observe(5);
  watch_->Fold(joined);
  Of(two_).speaks = Of(two_).truth.present = true;
  Observe({{.kind = EventKind::kJoined, .vehicle = two_}});
  Observe(200);
  Halt(one_, two_);
  Observe(30);
  EXPECT_EQ(Count(Invariant::kOrder), 1U);
}

TEST_F(InvariantWatchTest, WhereNobodyWasSeenNothingIsClaimed) {
  watch_->Finish(true);
  Report report;
  report.verdict = Verdict::kPassed;
  watch_->AddTo(&report);
  EXPECT_EQ(report.verdict, Verdict::kPassed);
  EXPECT_THAT(report.violations, IsEmpty());
  EXPECT_THAT(ToTable(report, 80), HasSubstr("not judged"));
}

TEST_F(InvariantWatchTest, AVehicleThatBelievesToBeElsewhereIsFound) {
  Observe(20);
  EXPECT_EQ(Count(Invariant::kPose), 0U);
  Of(one_).beacon.world_from_body.position_world = {3.6, 0};
  Observe(20);
  watch_->Finish(false);
  EXPECT_EQ(Count(Invariant::kPose), 1U);
}

}  // namespace
}  // namespace giveway::fleetctl

// Every invariant is tripped by what breaks it, and not by what comes near.
#include "sim_world/virtual/invariants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

namespace giveway::sim {
namespace {

constexpr double kTick_s = 0.05;

// Three vehicles driving, with nothing wrong; a test changes what it is about.
class InvariantsTest : public testing::Test {
 protected:
  InvariantsTest() {
    scenario_.vehicles.resize(3);
    for (std::uint32_t i = 0; i < 3; ++i) {
      VehicleOptions& options = scenario_.vehicles[i];
      options.id = VehicleId{i + 1};
      options.profile = PioneerP3dx();
      options.goal.set = true;
      Observed& vehicle = now_.emplace_back();
      vehicle.vehicle = options.id;
      vehicle.present = true;
      vehicle.lives = true;
      vehicle.position_world = {10.0 * i, 0};
      vehicle.forward_m_s = 0.3;
      vehicle.decision = {.mode = Mode::kCooperative, .rule = Rule::kCruise};
      vehicle.order = {.speed_bucket = 10 - i, .vehicle = options.id};
    }
    Begin({});
  }

  void Begin(const InvariantLimits& limits) { invariants_.emplace(scenario_, limits); }
  void Observe(std::vector<WorldEvent> events = {}) {
    ++tick_;
    for (WorldEvent& event : events) event.tick = Tick{tick_};
    for (Observed& vehicle : now_) {
      if (answers_) vehicle.answered = Tick{tick_};
      vehicle.rim_m_s = std::max(vehicle.forward_m_s, 0.0) + turning_m_s_;
    }
    invariants_->Observe(Tick{tick_}, tick_ * kTick_s, now_, events);
  }
  void Observe(int ticks) {
    for (int i = 0; i < ticks; ++i) Observe();
  }
  // They come on by as much as they are fast.
  void Drive(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      for (Observed& vehicle : now_) vehicle.position_world.x += vehicle.forward_m_s * kTick_s;
      Observe();
    }
  }
  Observed& Vehicle(std::uint32_t id) { return now_[id - 1]; }
  void Halt(std::uint32_t id, Rule rule, std::uint32_t peer) {
    Vehicle(id).forward_m_s = 0;
    Vehicle(id).decision.rule = rule;
    Vehicle(id).decision.peer = VehicleId{peer};
    Vehicle(id).gives_way_to = VehicleId{rule == Rule::kGiveWay ? peer : 0};
  }
  std::uint32_t Count(Invariant invariant) const { return invariants_->Count(invariant); }

  Scenario scenario_;
  std::vector<Observed> now_;
  std::optional<Invariants> invariants_;
  std::uint32_t tick_ = 0;
  bool answers_ = true;
  double turning_m_s_ = 0;  // of the outer wheel relative to the middle
};

TEST_F(InvariantsTest, HoldWhileNothingIsWrong) {
  Observe(100);
  Halt(3, Rule::kGiveWay, 1);
  Observe(100);
  for (Observed& vehicle : now_) {
    vehicle.arrived = true;
    vehicle.forward_m_s = 0;
  }
  invariants_->Finish(Tick{tick_}, now_);
  EXPECT_TRUE(invariants_->Held());
  EXPECT_TRUE(invariants_->First().empty());
}

TEST_F(InvariantsTest, AContactIsTheFaultOfWhoDrove) {
  Vehicle(1).forward_m_s = 0;
  Observe(2);
  Vehicle(2).forward_m_s = 0;  // the world has stopped it by the time it is seen
  Observe({{.kind = EventKind::kContact, .vehicle = VehicleId{1}, .other = VehicleId{2}}});
  EXPECT_EQ(Count(Invariant::kContact), 1U);
  ASSERT_EQ(invariants_->First().size(), 1U);
  EXPECT_EQ(invariants_->First()[0].vehicle, VehicleId{2});
  EXPECT_EQ(invariants_->First()[0].other, VehicleId{1});
  EXPECT_EQ(invariants_->First()[0].tick, Tick{tick_});
}

// From mixed_yard 506: an obstacle that moves along the rim ran into a vehicle that stood there.
TEST_F(InvariantsTest, WhatRunsIntoAStandingVehicleIsNotItsFault) {
  const WorldEvent contact{.kind = EventKind::kContact, .vehicle = VehicleId{1}};
  Vehicle(1).forward_m_s = 0;
  Observe(2);
  Observe({contact});
  EXPECT_EQ(Count(Invariant::kContact), 0U);
  // It sets off: the world has stopped it by the time it is seen.
  Vehicle(1).position_world.x += 0.001;
  Observe({contact});
  EXPECT_EQ(Count(Invariant::kContact), 1U);
}

// Regression: a box that turned a corner into a wall was excused as a body that stood.
TEST_F(InvariantsTest, ABoxThatTurnsACornerIntoAWallIsAtFaultAndADiscTurnsIntoNothing) {
  const WorldEvent contact{.kind = EventKind::kContact, .vehicle = VehicleId{1}};
  for (const BodyShape shape : {BodyShape::kDisc, BodyShape::kBox}) {
    scenario_.vehicles[0].profile.shape = shape;
    Begin({});
    turning_m_s_ = 0;
    Vehicle(1).forward_m_s = 0;
    Observe();
    Observe({contact});
    EXPECT_EQ(Count(Invariant::kContact), 0U) << "what runs into it while it stands";
    turning_m_s_ = 0.2;
    Observe();
    turning_m_s_ = 0;  // the world has stopped it by the time it is seen
    Observe({contact});
    EXPECT_EQ(Count(Invariant::kContact), shape == BodyShape::kBox ? 1U : 0U);
    Observe();
    Vehicle(1).heading_rad += 0.001;  // in this tick alone
    Observe({contact});
    EXPECT_EQ(Count(Invariant::kContact), shape == BodyShape::kBox ? 2U : 0U);
  }
}

// Regression: it was the lower id's, whichever turned.
TEST_F(InvariantsTest, OfTwoOnTheSpotTheBoxThatTurnsIsAtFault) {
  scenario_.vehicles[1].profile.shape = BodyShape::kBox;
  Begin({});
  Vehicle(1).forward_m_s = Vehicle(2).forward_m_s = 0;
  turning_m_s_ = 0.2;
  Observe();
  Observe({{.kind = EventKind::kContact, .vehicle = VehicleId{1}, .other = VehicleId{2}}});
  ASSERT_EQ(invariants_->First().size(), 1U);
  EXPECT_EQ(invariants_->First()[0].vehicle, VehicleId{2});
}

TEST_F(InvariantsTest, AContactWithAWallIsTheFaultOfTheOnlyVehicle) {
  Observe({{.kind = EventKind::kContact, .vehicle = VehicleId{3}}});
  EXPECT_EQ(invariants_->First()[0].vehicle, VehicleId{3});
  EXPECT_EQ(invariants_->First()[0].other, kNoVehicle);
}

TEST_F(InvariantsTest, BrakingOnStaleRangesIsAllowedAndDrivingOnIsNot) {
  Vehicle(1).decision = {.mode = Mode::kHalt, .rule = Rule::kRangesStale};
  Observe();
  while (Vehicle(1).forward_m_s > 0) {
    Observe();
    Vehicle(1).forward_m_s = std::max(0.0, Vehicle(1).forward_m_s - 0.6 * kTick_s);
  }
  Observe(10);
  EXPECT_EQ(Count(Invariant::kStaleMotion), 0U);
  Vehicle(1).forward_m_s = 0.05;
  Observe(10);
  EXPECT_EQ(Count(Invariant::kStaleMotion), 1U);
}

// While others came and went 13 ticks were not seen whole, in which it drove: a soak said that it
// had moved on stale data.
TEST_F(InvariantsTest, WhatWasNotSeenIsNotHeldAgainstOneThatIsStaleAgain) {
  Vehicle(1).decision = {.mode = Mode::kHalt, .rule = Rule::kRangesStale};
  Vehicle(1).forward_m_s = 0;
  Observe(5);
  tick_ += 13;
  Vehicle(1).forward_m_s = 0.06;
  Observe();
  EXPECT_EQ(Count(Invariant::kStaleMotion), 0U);
  Vehicle(1).forward_m_s = 0.3;
  Observe(3);
  EXPECT_EQ(Count(Invariant::kStaleMotion), 1U) << "it does not brake";
}

TEST_F(InvariantsTest, TurningOnTheSpotOnStaleRangesIsMotion) {
  Vehicle(1).forward_m_s = 0;
  Vehicle(1).decision = {.mode = Mode::kHalt, .rule = Rule::kRangesStale};
  turning_m_s_ = 0.1;
  Observe(20);
  EXPECT_EQ(Count(Invariant::kStaleMotion), 1U);
}

TEST_F(InvariantsTest, WhoseLastCommandIsOlderThanTheWatchdogMustBrake) {
  Observe();
  answers_ = false;
  Observe(5);  // the watchdog's three ticks, and one to notice
  EXPECT_EQ(Count(Invariant::kStaleMotion), 0U);
  Observe(5);
  EXPECT_EQ(Count(Invariant::kStaleMotion), 3U);
}

TEST_F(InvariantsTest, ACircleOfThoseWhoGiveWayIsFoundOnce) {
  Halt(1, Rule::kGiveWay, 2);
  Halt(2, Rule::kGiveWay, 3);
  Observe(3);
  EXPECT_EQ(Count(Invariant::kWaitCycle), 0U);
  Halt(3, Rule::kGiveWay, 1);
  Observe(3);
  EXPECT_EQ(Count(Invariant::kWaitCycle), 1U);
}

TEST_F(InvariantsTest, ACircleMayLastAsLongAsNewsTakes) {
  Begin({.cycle_ticks = 2});
  Halt(1, Rule::kGiveWay, 2);
  Halt(2, Rule::kGiveWay, 1);
  Observe(2);
  EXPECT_EQ(Count(Invariant::kWaitCycle), 0U);
  Observe();
  EXPECT_EQ(Count(Invariant::kWaitCycle), 1U);
}

TEST_F(InvariantsTest, WhoOnlyBrakesDoesNotWaitYet) {
  Halt(1, Rule::kGiveWay, 2);
  Halt(2, Rule::kGiveWay, 1);
  Vehicle(1).forward_m_s = 0.2;
  Observe(3);
  EXPECT_EQ(Count(Invariant::kWaitCycle), 0U);
}

TEST_F(InvariantsTest, WaitingIsBounded) {
  Begin({.wait_s = 1});
  Halt(3, Rule::kGiveWay, 1);
  Drive(20);
  EXPECT_EQ(Count(Invariant::kWaitBound), 0U);
  Drive(20);
  EXPECT_EQ(Count(Invariant::kWaitBound), 1U);
}

TEST_F(InvariantsTest, AWaitThatEndsBeginsAnew) {
  Begin({.wait_s = 1});
  Halt(3, Rule::kGiveWay, 1);
  Drive(15);
  Vehicle(3).forward_m_s = 2.1;
  Drive(1);
  Vehicle(3).forward_m_s = 0;
  Drive(15);
  EXPECT_EQ(Count(Invariant::kWaitBound), 0U);
}

TEST_F(InvariantsTest, AllMayHaltForTwoPeriodsAndNoLonger) {
  Halt(1, Rule::kNotGranted, 2);
  Halt(2, Rule::kGiveWay, 1);
  Vehicle(3).arrived = true;
  Vehicle(3).forward_m_s = 0;
  Observe(2);
  EXPECT_EQ(Count(Invariant::kAllHalted), 0U);
  Observe();
  EXPECT_EQ(Count(Invariant::kAllHalted), 1U);
}

// At 0.5 m/s it takes nine ticks to stand, and is let roll out.
TEST_F(InvariantsTest, WhileOneThatHasArrivedStillRollsThereIsSomebodyToLetGo) {
  Halt(1, Rule::kGiveWay, 3);
  Halt(2, Rule::kGiveWay, 3);
  Vehicle(3).arrived = true;
  Vehicle(3).forward_m_s = 0.2;
  Observe(10);
  EXPECT_EQ(Count(Invariant::kAllHalted), 0U);
  Vehicle(3).forward_m_s = 0;
  Observe(10);
  EXPECT_EQ(Count(Invariant::kAllHalted), 1U);
}

TEST_F(InvariantsTest, OneWithAnotherReasonToStandIsNoCaseOfAllHalted) {
  Halt(1, Rule::kNotGranted, 2);
  Halt(2, Rule::kGiveWay, 1);
  Halt(3, Rule::kPeerLost, 1);
  Observe(10);
  EXPECT_EQ(Count(Invariant::kAllHalted), 0U);
}

TEST_F(InvariantsTest, OnlyTheLowerInTheOrderGivesWay) {
  Halt(3, Rule::kGiveWay, 1);
  Observe(5);
  EXPECT_EQ(Count(Invariant::kOrder), 0U);
  Halt(1, Rule::kGiveWay, 2);
  Observe(5);
  EXPECT_EQ(Count(Invariant::kOrder), 1U);
}

TEST_F(InvariantsTest, AKeyPublishedAMomentAgoStillCounts) {
  Observe(5);
  Vehicle(1).order.speed_bucket = 1;  // now the last
  Halt(2, Rule::kGiveWay, 1);
  Observe(6);
  EXPECT_EQ(Count(Invariant::kOrder), 0U);
  Observe(5);
  EXPECT_EQ(Count(Invariant::kOrder), 1U);
}

TEST_F(InvariantsTest, OfTwoThatActByOneKeyTheLowerIdGoesFirst) {
  Vehicle(1).order = Vehicle(2).order = Vehicle(3).order;
  Halt(2, Rule::kGiveWay, 1);
  Observe(3);
  EXPECT_EQ(Count(Invariant::kOrder), 0U);
  Halt(1, Rule::kGiveWay, 2);
  Observe(3);
  EXPECT_EQ(Count(Invariant::kOrder), 1U);
}

TEST_F(InvariantsTest, WhoLivesAndHasAGoalMustArrive) {
  Vehicle(1).arrived = true;
  Vehicle(1).forward_m_s = 0;
  Vehicle(2).lives = false;
  Observe();
  invariants_->Finish(Tick{tick_}, now_);
  EXPECT_EQ(Count(Invariant::kArrival), 1U);
  EXPECT_EQ(invariants_->First()[0].vehicle, VehicleId{3});
  EXPECT_FALSE(invariants_->Held());
}

TEST_F(InvariantsTest, WhereABeaconSaysItsVehicleWasItMustHaveBeen) {
  const auto say = [this](double off_m, double sigma_m) {
    Observed& one = Vehicle(1);
    one.position_world.x += 0.02;  // the beacon is of the tick before
    one.stated = Tick{tick_};
    one.stated_position_world = {one.position_world.x - 0.02 + off_m, 0};
    one.stated_covariance.xx_m2 = sigma_m * sigma_m;
    Observe();
  };
  Observe();
  for (int i = 0; i < 10; ++i) say(0.099, 0);
  for (int i = 0; i < 10; ++i) say(0.39, 0.1);
  EXPECT_TRUE(invariants_->Held());
  for (int i = 0; i < 10; ++i) say(0.41, 0.1);
  EXPECT_EQ(Count(Invariant::kPose), 1U);  // once, however long
  say(0, 0);
  say(std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(Count(Invariant::kPose), 2U);
}

TEST_F(InvariantsTest, OfAPlaceToldLongAgoOrBeforeTheFirstScanNothingIsSaid) {
  Observe(10);
  Vehicle(1).stated = kNoTick;
  Vehicle(1).stated_position_world = {50, 50};
  Observe();
  Vehicle(1).stated = Tick{tick_};
  Vehicle(1).stated_position_world = Vehicle(1).position_world;
  for (std::uint32_t i = 0; i < 2 * Invariants::kRememberedKeys; ++i) {
    Vehicle(1).position_world.x += 1;
    Observe();
  }
  EXPECT_TRUE(invariants_->Held());
}

// Whatever reason it gives: a reason does not excuse standing.
TEST_F(InvariantsTest, StandingIsBoundWhateverItIsFor) {
  Begin({.wait_s = 2});
  for (const Rule rule : {Rule::kObstacle, Rule::kKeepClear, Rule::kCruise, Rule::kGiveWay}) {
    for (int i = 0; i < 10; ++i) {
      Halt(1, rule, 0);
      Observe();
    }
  }
  EXPECT_EQ(Count(Invariant::kWaitBound), 0U);  // 40 ticks are 2 s
  Observe(2);
  EXPECT_EQ(Count(Invariant::kWaitBound), 3U);  // none of them has moved
}

TEST_F(InvariantsTest, WhoCreepsOrTurnsAboutOnOnePlaceStands) {
  Begin({.wait_s = 2});
  for (int i = 0; i < 45; ++i) {
    Vehicle(1).position_world = {i % 2 == 0 ? 0.0 : 0.05, 0};
    Vehicle(2).position_world.x += 0.01;
    Vehicle(3).position_world.x += 0.01;
    Observe();
  }
  EXPECT_EQ(Count(Invariant::kWaitBound), 1U);
  EXPECT_EQ(invariants_->First()[0].vehicle, VehicleId{1});
}

TEST_F(InvariantsTest, OfThoseWhoShareAGoalOneMustArriveAndTheOthersMayStand) {
  Begin({.wait_s = 2, .one_of = {{VehicleId{1}, VehicleId{2}, VehicleId{3}}}});
  Observe(60);
  EXPECT_EQ(Count(Invariant::kWaitBound), 0U);
  Vehicle(2).forward_m_s = 0;
  invariants_->Finish(Tick{tick_}, now_);
  EXPECT_EQ(Count(Invariant::kArrival), 1U);
  Begin({.one_of = {{VehicleId{1}, VehicleId{2}, VehicleId{3}}}});
  Vehicle(2).arrived = true;
  invariants_->Finish(Tick{tick_}, now_);
  EXPECT_EQ(Count(Invariant::kArrival), 0U);
}

// In its goal and driving through is not there.
TEST_F(InvariantsTest, ArrivedIsStandingInTheGoal) {
  for (Observed& vehicle : now_) {
    vehicle.arrived = true;
    vehicle.forward_m_s = 0;
  }
  Vehicle(2).forward_m_s = 0.2;
  invariants_->Finish(Tick{tick_}, now_);
  EXPECT_EQ(Count(Invariant::kArrival), 1U);
}

TEST_F(InvariantsTest, WhoIsDueAndNotThereIsLate) {
  Begin({.due = {{VehicleId{1}, 1.0}, {VehicleId{2}, 1.0}, {VehicleId{3}, 5.0}}});
  Vehicle(2).arrived = true;
  Observe(20);
  EXPECT_EQ(Count(Invariant::kDelay), 0U);
  Observe(20);
  EXPECT_EQ(Count(Invariant::kDelay), 1U);
  EXPECT_TRUE(invariants_->Held());
}

TEST_F(InvariantsTest, SayByWhichRule) {
  Halt(2, Rule::kObstacle, 0);
  Observe({{.kind = EventKind::kContact, .vehicle = VehicleId{2}, .other = kNoVehicle}});
  ASSERT_EQ(invariants_->First().size(), 1U);
  EXPECT_EQ(invariants_->First()[0].rule, Rule::kObstacle);
}

}  // namespace
}  // namespace giveway::sim

#include "sim_world/run/run_evaluator.h"

#include <gtest/gtest.h>

#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

// One vehicle with a goal at (5, 0), moved by hand.
class RunEvaluatorTest : public testing::Test {
 protected:
  RunEvaluatorTest() : evaluator_(ScenarioOf({Vehicle()})) {
    body_.vehicle = kTwo;
    body_.profile = PioneerP3dx();
    body_.goal = Vehicle().goal;
    body_.present = true;
    body_.obeyed = true;
    body_.command.decision = {.mode = Mode::kCooperative, .rule = Rule::kCruise};
    SetSpeed(0.3);
  }
  static VehicleOptions Vehicle() {
    VehicleOptions options = VehicleAt(2, {});
    options.goal = {.set = true, .at_world = {5, 0}, .radius_m = 0.1};
    return options;
  }
  void SetSpeed(double forward_m_s) {
    body_.wheels = WheelsFromTwist(body_.profile.drive, {forward_m_s, 0});
  }
  // Observes `ticks` ticks; collects their events.
  void Observe(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      log_.BeginTick(Tick{1}, 0);
      time_s_ += 0.05;
      evaluator_.Observe(time_s_, {&body_, 1}, {}, &log_);
      events_.insert(events_.end(), log_.Events().begin(), log_.Events().end());
    }
  }

  RunEvaluator evaluator_;
  Body body_;
  EventLog log_{kEpoch};
  std::vector<WorldEvent> events_;
  double time_s_ = 0;
};

TEST_F(RunEvaluatorTest, StandingHalfASecondToGiveWayIsAHaltAndOnlyOne) {
  SetSpeed(0.009);
  body_.command.decision = {.rule = Rule::kGiveWay, .peer = VehicleId{1}};
  Observe(9);
  EXPECT_TRUE(events_.empty());
  Observe(50);
  ASSERT_EQ(events_.size(), 1U);
  EXPECT_EQ(events_[0].kind, EventKind::kHalted);
  EXPECT_EQ(events_[0].vehicle, kTwo);
  EXPECT_EQ(events_[0].other, VehicleId{1});
  EXPECT_EQ(evaluator_.Halted(), std::vector{kTwo});
}

TEST_F(RunEvaluatorTest, AHaltNamesTheRuleThatBeganTheStop) {
  body_.command.decision.rule = Rule::kUnidentifiedMotion;
  Observe(3);  // braking: heard late, the other is given way to in the end
  body_.command.decision = {.rule = Rule::kGiveWay, .peer = VehicleId{1}};
  SetSpeed(0);
  Observe(10);
  ASSERT_EQ(events_.size(), 1U);
  EXPECT_EQ(events_[0].text, "deaf");
  EXPECT_EQ(evaluator_.HaltedFor(), std::vector{Rule::kUnidentifiedMotion});
}

TEST_F(RunEvaluatorTest, AStopThatWasCalledOffIsNoCauseOfTheNextHalt) {
  body_.command.decision.rule = Rule::kUnidentifiedMotion;
  Observe(3);
  body_.command.decision.rule = Rule::kCruise;
  Observe(1);
  body_.command.decision.rule = Rule::kPeerLost;
  SetSpeed(0);
  Observe(10);
  EXPECT_EQ(evaluator_.HaltedFor(), std::vector{Rule::kPeerLost});
  SetSpeed(0.1);  // drives again, and at once blocks another
  body_.command.decision.rule = Rule::kGiveWay;
  Observe(2);
  SetSpeed(0);
  Observe(10);
  EXPECT_EQ(evaluator_.HaltedFor(), (std::vector{Rule::kGiveWay, Rule::kPeerLost}));
}

TEST_F(RunEvaluatorTest, AVehicleThatMovesAgainWentOn) {
  SetSpeed(0);
  body_.command.decision = {.rule = Rule::kUnidentifiedMotion};
  Observe(10);
  body_.command.decision = {.rule = Rule::kCruise};
  Observe(10);  // still stands: nothing new
  EXPECT_EQ(events_.size(), 1U);
  SetSpeed(0.02);
  Observe(10);
  ASSERT_EQ(events_.size(), 2U);
  EXPECT_EQ(events_[1].kind, EventKind::kResumed);
}

TEST_F(RunEvaluatorTest, StandingForAnotherReasonIsNoHalt) {
  SetSpeed(0);
  for (const Rule rule : {Rule::kObstacle, Rule::kRangesStale, Rule::kNotRunning, Rule::kCruise}) {
    body_.command.decision = {.rule = rule};
    Observe(40);
  }
  EXPECT_TRUE(evaluator_.Halted().empty());
}

TEST_F(RunEvaluatorTest, AnInterruptedStandstillStartsAnew) {
  body_.command.decision = {.rule = Rule::kGiveWay};
  for (int i = 0; i < 5; ++i) {
    SetSpeed(0);
    Observe(9);
    SetSpeed(0.05);
    Observe(1);
  }
  EXPECT_TRUE(evaluator_.Halted().empty());
}

// Its last command said "give way", but the process is gone and the world holds the brake.
TEST_F(RunEvaluatorTest, ADeadVehicleDoesNotHaltToGiveWay) {
  SetSpeed(0);
  body_.command.decision = {.rule = Rule::kGiveWay};
  body_.obeyed = false;
  Observe(40);
  EXPECT_TRUE(evaluator_.Halted().empty());
}

TEST_F(RunEvaluatorTest, ArrivalIsToStandWithTheAxleCentreWithinTheGoalsRadiusAndOnlyOnce) {
  SetSpeed(0);
  body_.world_from_body.position_world = {4.89, 0};
  Observe(1);
  EXPECT_FALSE(evaluator_.HasArrived(kTwo));
  body_.world_from_body.position_world = {4.95, 0.05};
  Observe(5);
  EXPECT_TRUE(evaluator_.HasArrived(kTwo));
  EXPECT_EQ(evaluator_.Arrived(), std::vector{kTwo});
  EXPECT_DOUBLE_EQ(evaluator_.LastArrival().value(), 0.1);
  ASSERT_EQ(events_.size(), 1U);
  EXPECT_EQ(events_[0].kind, EventKind::kArrived);
  EXPECT_DOUBLE_EQ(events_[0].value, 0.1);
}

TEST_F(RunEvaluatorTest, DrivingThroughTheGoalIsNoArrival) {
  for (const double x_m : {4.8, 4.95, 5.0, 5.05, 5.2}) {
    body_.world_from_body.position_world = {x_m, 0};
    Observe(1);
  }
  SetSpeed(0);
  Observe(20);
  EXPECT_FALSE(evaluator_.HasArrived(kTwo));
  EXPECT_TRUE(evaluator_.Arrived().empty());
  EXPECT_TRUE(events_.empty());
}

TEST_F(RunEvaluatorTest, WhoLeavesItsGoalAgainHasNotArrived) {
  body_.world_from_body.position_world = {5, 0};
  SetSpeed(0);
  Observe(5);
  ASSERT_TRUE(evaluator_.HasArrived(kTwo));
  SetSpeed(0.3);
  body_.world_from_body.position_world = {5.05, 0};
  Observe(1);
  EXPECT_TRUE(evaluator_.HasArrived(kTwo));
  body_.world_from_body.position_world = {5.11, 0};
  Observe(1);
  EXPECT_FALSE(evaluator_.HasArrived(kTwo));
  EXPECT_TRUE(evaluator_.Arrived().empty());
  EXPECT_FALSE(evaluator_.LastArrival());
  ASSERT_EQ(events_.size(), 2U);
  EXPECT_EQ(events_[1].kind, EventKind::kResumed);
}

TEST_F(RunEvaluatorTest, ABodyThatNobodyDrivesDoesNotArrive) {
  body_.world_from_body.position_world = {5, 0};
  SetSpeed(0);
  body_.obeyed = false;
  Observe(5);
  EXPECT_FALSE(evaluator_.HasArrived(kTwo));
}

TEST_F(RunEvaluatorTest, AnArrivalBeforeANewStartStillCounts) {
  body_.world_from_body.position_world = {5, 0};
  SetSpeed(0);
  Observe(1);
  evaluator_.Restart(kTwo);
  EXPECT_FALSE(evaluator_.HasArrived(kTwo));
  EXPECT_EQ(evaluator_.Arrived(), std::vector{kTwo});
}

TEST_F(RunEvaluatorTest, AfterArrivalNothingIsAHalt) {
  body_.world_from_body.position_world = {5, 0};
  SetSpeed(0);
  body_.command.decision = {.rule = Rule::kGiveWay};
  Observe(40);
  EXPECT_TRUE(evaluator_.Halted().empty());
}

TEST_F(RunEvaluatorTest, ContactsBecomeEvents) {
  const Contact contact = {.vehicle = VehicleId{1}, .other = kTwo, .position_world = {1, 2}};
  evaluator_.Observe(1, {&body_, 1}, {&contact, 1}, &log_);
  ASSERT_EQ(log_.Events().size(), 1U);
  EXPECT_EQ(log_.Events()[0].kind, EventKind::kContact);
  EXPECT_EQ(log_.Events()[0].other, kTwo);
  EXPECT_EQ(log_.Events()[0].position_world, (Vec2{1, 2}));
  EXPECT_EQ(log_.Events()[0].text, "");
}

TEST_F(RunEvaluatorTest, AContactWithNoVehicleSaysWithWhat) {
  std::vector<Contact> contacts(3, {.vehicle = kTwo});
  contacts[0].touched = Touched::kWall;
  contacts[1].touched = Touched::kObstacle;
  contacts[2].touched = Touched::kDoor;
  evaluator_.Observe(1, {&body_, 1}, contacts, &log_);
  ASSERT_EQ(log_.Events().size(), 3U);
  EXPECT_EQ(log_.Events()[0].text, "wall");
  EXPECT_EQ(log_.Events()[1].text, "obstacle");
  EXPECT_EQ(log_.Events()[2].text, "door");
}

}  // namespace
}  // namespace giveway::sim

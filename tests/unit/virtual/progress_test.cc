// Which vehicles are wedged, and which only wait.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "sim_world/virtual/invariants.h"

namespace giveway::sim {
namespace {

constexpr std::uint32_t kSecond = 20;  // ticks
constexpr std::uint32_t kLong = 62 * kSecond;

// Two vehicles driving east 1.5 m behind each other, the second waiting for the first, and a third
// far off; moved by hand.
class ProgressTest : public testing::Test {
 protected:
  ProgressTest() {
    scenario_.vehicles.resize(3);
    for (std::uint32_t i = 0; i < 3; ++i) {
      VehicleOptions& options = scenario_.vehicles[i];
      options.id = VehicleId{i + 1};
      options.profile = PioneerP3dx();
      options.goal = {.set = true, .at_world = {100, 0}};
      Observed& vehicle = now_.emplace_back();
      vehicle.vehicle = options.id;
      vehicle.present = true;
      vehicle.lives = true;
      vehicle.decision = {.mode = Mode::kCooperative, .rule = Rule::kSteerRound};
    }
    now_[0].position_world = {0, 0};
    now_[1].position_world = {-1.5, 0};
    now_[2].position_world = {0, 30};
    now_[1].decision.peer = VehicleId{1};
  }

  void Observe(std::uint32_t ticks) {
    if (!invariants_) invariants_.emplace(scenario_, InvariantLimits{.wait_s = 1000});
    for (std::uint32_t i = 0; i < ticks; ++i) {
      ++tick_;
      for (std::size_t v = 0; v < 3; ++v) {
        now_[v].position_world.x += speed_m_s_[v] / kSecond;
        now_[v].forward_m_s = speed_m_s_[v];
      }
      invariants_->Observe(Tick{tick_}, 0.05 * tick_, now_, {});
    }
  }
  std::uint32_t Wedged() const { return invariants_->Count(Invariant::kProgress); }

  Scenario scenario_;
  std::vector<Observed> now_;
  std::vector<double> speed_m_s_ = {0, 0, 0.3};
  std::optional<Invariants> invariants_;
  std::uint32_t tick_ = 0;
};

TEST_F(ProgressTest, WhoComesNoNearerForAMinuteIsWedgedWhateverTheRuleIsCalled) {
  Observe(60 * kSecond);
  EXPECT_EQ(Wedged(), 0U);
  Observe(2 * kSecond);
  EXPECT_EQ(Wedged(), 2U);
  EXPECT_EQ(invariants_->First()[0].vehicle, VehicleId{1});
  Observe(kLong);
  EXPECT_EQ(Wedged(), 2U);  // counted when it starts
}

TEST_F(ProgressTest, DrivingAboutIsNoProgress) {
  for (int i = 0; i < 62; ++i) {
    speed_m_s_[0] = i % 2 == 0 ? 0.3 : -0.3;
    Observe(kSecond);
  }
  EXPECT_EQ(Wedged(), 2U);
}

TEST_F(ProgressTest, WaitingInAQueueThatMovesIsNoWedge) {
  for (int i = 0; i < 6; ++i) {
    speed_m_s_[0] = 0.15;
    Observe(kSecond);
    speed_m_s_[0] = 0;
    Observe(50 * kSecond);
  }
  EXPECT_EQ(Wedged(), 0U);
}

TEST_F(ProgressTest, AfterTheOthersHaveGoneThereIsAMinuteToDriveOff) {
  speed_m_s_[0] = 0.02;
  Observe(100 * kSecond);
  now_[1].decision.peer = kNoVehicle;
  Observe(55 * kSecond);
  EXPECT_EQ(Wedged(), 0U);
  Observe(20 * kSecond);
  EXPECT_EQ(Wedged(), 1U);
}

TEST_F(ProgressTest, WaitingForOneFarOffThatItNamesIsNoWedge) {
  now_[0].gives_way_to = VehicleId{3};
  Observe(kLong);
  EXPECT_EQ(Wedged(), 0U);
  now_[0].gives_way_to = kNoVehicle;
  Observe(kLong);
  EXPECT_EQ(Wedged(), 2U);
}

TEST_F(ProgressTest, TrafficThatPassesByOnItsOwnAccountHidesNoWedge) {
  now_[2].position_world = {-20, 1};
  speed_m_s_[2] = 0.5;
  Observe(kLong);
  EXPECT_EQ(Wedged(), 2U);
}

TEST_F(ProgressTest, BehindOneThatHasArrivedItIsAWedge) {
  now_[0].arrived = true;
  Observe(kLong);
  EXPECT_EQ(Wedged(), 1U);
  EXPECT_EQ(invariants_->First()[0].vehicle, VehicleId{2});
}

TEST_F(ProgressTest, ARedLightExcusesTheWholeQueueButOnlyWhileThereIsRed) {
  scenario_.signals = {{.id = SignalId{1},
                        .line_from_world = {1, -1},
                        .line_to_world = {1, 1},
                        .green_s = 1000,
                        .yellow_s = 0,
                        .red_s = 200,
                        .offset_s = 1000}};
  now_[0].decision.rule = Rule::kSignal;
  Observe(200 * kSecond);
  EXPECT_EQ(Wedged(), 0U);
  Observe(kLong);  // it is green, and they still stand
  EXPECT_EQ(Wedged(), 2U);
}

TEST_F(ProgressTest, AClosedDoorAndADeadVehicleExcuse) {
  scenario_.doors = {{.from_world = {1, -1}, .to_world = {1, 1}, .closed_s = 200, .open_s = 1000}};
  Observe(200 * kSecond);
  EXPECT_EQ(Wedged(), 0U);
  now_[0].lives = false;
  Observe(kLong);
  EXPECT_EQ(Wedged(), 0U);
  now_[0].present = false;
  Observe(kLong);
  EXPECT_EQ(Wedged(), 1U);
}

TEST_F(ProgressTest, AWaypointPassedIsProgressAndALoopNeverEnds) {
  Route& route = scenario_.vehicles[2].route;
  route.waypoints_world[0] = {10, 30};
  route.waypoints_world[1] = {0, 30};
  route.count = 2;
  route.loop = true;
  speed_m_s_ = {0.3, 0.3, 0.3};
  for (int i = 0; i < 6; ++i) {
    speed_m_s_[2] = now_[2].position_world.x > 5 ? -0.3 : 0.3;
    Observe(30 * kSecond);
  }
  EXPECT_EQ(Wedged(), 0U);
  speed_m_s_[2] = 0;
  Observe(kLong);
  EXPECT_EQ(Wedged(), 1U);
}

TEST_F(ProgressTest, WhoWantsToGoNowhereIsNeverWedged) {
  for (VehicleOptions& options : scenario_.vehicles) options.goal.set = false;
  Observe(kLong);
  EXPECT_EQ(Wedged(), 0U);
}

}  // namespace
}  // namespace giveway::sim

// Which vehicles drive too near to what, and which only stand or leave.
#include "sim_world/virtual/clearance.h"

#include <gtest/gtest.h>

#include <vector>

#include "services/types/math/math.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::sim {
namespace {

class ClearanceTest : public testing::Test {
 protected:
  ClearanceTest() {
    for (std::uint32_t i = 1; i <= 2; ++i) {
      VehicleOptions options;
      options.id = VehicleId{i};
      options.profile = PioneerP3dx();
      scenario_.vehicles.push_back(options);
      now_.push_back({.vehicle = options.id, .present = true, .lives = true});
    }
    now_[0].forward_m_s = 0.3;
    now_[1].position_world = {10, 10};
  }
  // How many are reported, of the scenario as it is, in one tick.
  std::size_t Violations() {
    Clearance clearance(scenario_, 0.05);
    return clearance.Observe(now_, {}).size();
  }

  Scenario scenario_;
  std::vector<Observed> now_;
};

TEST_F(ClearanceTest, FiveCentimetresBetweenShellsAreEnough) {
  now_[1].position_world = {0.551, 0};
  EXPECT_EQ(Violations(), 0U);
  now_[1].position_world = {0.549, 0};
  EXPECT_EQ(Violations(), 1U);
}

TEST_F(ClearanceTest, OnlyOfWhoMovesTowards) {
  now_[1].position_world = {0.52, 0};
  now_[0].forward_m_s = 0;
  EXPECT_EQ(Violations(), 0U);
  now_[0].forward_m_s = -0.3;
  EXPECT_EQ(Violations(), 0U);
  now_[0].forward_m_s = 0.3;
  now_[0].heading_rad = kPi / 2;
  EXPECT_EQ(Violations(), 0U);
}

TEST_F(ClearanceTest, OfWallsFromAnySide) {
  scenario_.walls.push_back({{0.29, -5}, {0.29, 5}});
  EXPECT_EQ(Violations(), 1U);
  scenario_.walls[0] = {{0.31, -5}, {0.31, 5}};
  EXPECT_EQ(Violations(), 0U);
  scenario_.walls[0] = {{0.28, 0}, {3, 0}};  // its end
  EXPECT_EQ(Violations(), 1U);
}

// The disc round it may reach over: a box is judged by its sides.
TEST_F(ClearanceTest, OfABoxByItsSides) {
  scenario_.vehicles[1].profile.shape = BodyShape::kBox;
  scenario_.vehicles[1].profile.box_half_m = {0.4, 0.2};
  scenario_.vehicles[1].profile.body_radius_m = 0.4472;
  now_[1].position_world = {0.6, 0};
  now_[1].heading_rad = kPi / 2;
  EXPECT_EQ(Violations(), 0U);  // 0.15 m to its flank
  now_[1].heading_rad = 0;
  EXPECT_EQ(Violations(), 1U);
}

TEST_F(ClearanceTest, OfObstaclesAndOfLeavesThatAreNotOpen) {
  Obstacle obstacle;
  obstacle.start_world = {{0.54, 0}, 0};
  const std::vector<MovingObstacle> obstacles{MovingObstacle(obstacle)};
  EXPECT_EQ(Clearance(scenario_, 0.05).Observe(now_, {.obstacles = obstacles}).size(), 1U);
  const std::vector<SlidingDoor> doors{
      SlidingDoor({.from_world = {0.28, -1}, .to_world = {0.28, 1}})};
  EXPECT_EQ(Clearance(scenario_, 0.05).Observe(now_, {.doors = doors}).size(), 1U);
}

TEST_F(ClearanceTest, EachTimeIsToldOnce) {
  Clearance clearance(scenario_, 0.05);
  now_[1].position_world = {0.54, 0};
  ASSERT_EQ(clearance.Observe(now_, {}).size(), 1U);
  EXPECT_EQ(clearance.Observe(now_, {}).size(), 0U);
  now_[1].position_world = {2, 0};
  clearance.Observe(now_, {});
  now_[1].position_world = {0.54, 0};
  EXPECT_EQ(clearance.Observe(now_, {})[0].other, VehicleId{2});
}

// Counted and named; a run passes nevertheless unless it is held to it.
TEST_F(ClearanceTest, IsNoReasonToFailUnlessAskedFor) {
  now_[1].position_world = {0.54, 0};
  InvariantLimits limits;
  Invariants counted(scenario_, limits);
  counted.Observe(Tick{1}, 0.05, now_, {});
  EXPECT_EQ(counted.Count(Invariant::kClearance), 1U);
  EXPECT_TRUE(counted.Held());
  EXPECT_EQ(counted.Broken(), 0U);
  EXPECT_TRUE(counted.First().empty());
  ASSERT_EQ(counted.FirstNoted().size(), 1U);
  limits.required.set(static_cast<std::size_t>(Invariant::kClearance));
  Invariants held_to(scenario_, limits);
  held_to.Observe(Tick{1}, 0.05, now_, {});
  EXPECT_FALSE(held_to.Held());
  EXPECT_EQ(held_to.Broken(), 1U);
  EXPECT_EQ(held_to.First().size(), 1U);
}

// Of real runs, which report those alone that are required, the others are not judged.
TEST_F(ClearanceTest, IsNotEvenCountedWhereOthersAreNotUnlessAskedFor) {
  now_[1].position_world = {0.54, 0};
  InvariantLimits limits{.counts_others = false};
  Invariants left_out(scenario_, limits);
  left_out.Observe(Tick{1}, 0.05, now_, {});
  EXPECT_EQ(left_out.Count(Invariant::kClearance), 0U);
  limits.required.set(static_cast<std::size_t>(Invariant::kClearance));
  Invariants held_to(scenario_, limits);
  held_to.Observe(Tick{1}, 0.05, now_, {});
  EXPECT_EQ(held_to.Broken(), 1U);
}

}  // namespace
}  // namespace giveway::sim

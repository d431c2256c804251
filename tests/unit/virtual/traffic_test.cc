// What the time of a fleet went to, by hand.
#include "sim_world/virtual/traffic.h"

#include <gtest/gtest.h>

#include <vector>

namespace giveway::sim {
namespace {

constexpr std::uint64_t kTick_ns = 50'000'000;

// One vehicle driving, and one that has arrived.
class TrafficTest : public testing::Test {
 protected:
  TrafficTest() : now_(2), traffic_(2, kTick_ns) {
    for (Observed& vehicle : now_) {
      vehicle.present = true;
      vehicle.lives = true;
      vehicle.decision.rule = Rule::kCruise;
      vehicle.forward_m_s = 0.3;
    }
    now_[1].arrived = true;
  }
  void Drive(double forward_m_s, int ticks) {
    now_[0].forward_m_s = forward_m_s;
    for (int i = 0; i < ticks; ++i) traffic_.Observe(now_);
  }
  std::uint64_t Ticks(Rule rule) const {
    return traffic_.Figures().by_rule_ns[static_cast<std::size_t>(rule)] / kTick_ns;
  }

  std::vector<Observed> now_;
  Traffic traffic_;
};

TEST_F(TrafficTest, TimeIsThatOfVehiclesOnTheirWayByTheirRule) {
  Drive(0.3, 7);
  now_[0].decision.rule = Rule::kGiveWay;
  Drive(0, 4);
  now_[0].lives = false;
  Drive(0, 9);
  EXPECT_EQ(Ticks(Rule::kCruise), 7U);
  EXPECT_EQ(Ticks(Rule::kGiveWay), 4U);
}

TEST_F(TrafficTest, AStopIsCountedOnceAndOnlyOfOneThatMoved) {
  Drive(0, 5);
  EXPECT_EQ(traffic_.Figures().stops, 0U);
  Drive(0.3, 5);
  for (int i = 0; i < 5; ++i) {  // creeps up
    Drive(0, 1);
    Drive(0.03, 1);
  }
  EXPECT_EQ(traffic_.Figures().stops, 1U);
  Drive(0.3, 1);
  Drive(0, 1);
  EXPECT_EQ(traffic_.Figures().stops, 2U);
}

TEST_F(TrafficTest, WhatIsTakenBackIsAWordThatWasGiven) {
  for (const std::uint32_t to : {0U, 0U, 4U, 4U, 5U, 5U, 0U, 0U, 4U}) {
    now_[0].gives_way_to = VehicleId{to};
    Drive(0.3, 1);
  }
  EXPECT_EQ(traffic_.Figures().taken_back, 2U);
}

TEST_F(TrafficTest, SumsAreOfEveryFigure) {
  now_[0].gives_way_to = VehicleId{4};
  Drive(0.3, 1);
  now_[0].gives_way_to = kNoVehicle;
  Drive(0, 1);
  TrafficFigures sum = traffic_.Figures();
  sum += traffic_.Figures();
  EXPECT_EQ(sum.by_rule_ns[static_cast<std::size_t>(Rule::kCruise)], 4 * kTick_ns);
  EXPECT_EQ(sum.stops, 2U);
  EXPECT_EQ(sum.taken_back, 2U);
}

}  // namespace
}  // namespace giveway::sim

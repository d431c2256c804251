// World and brains together, in memory: the crossing as the scenarios configure it, over many
// seeds.
#include "tests/support/crossing.h"

#include <gtest/gtest.h>

#include "services/types/math/random.h"

namespace giveway {
namespace {

using test::Crossing;
using test::Finish;
using Ids = std::set<std::uint32_t>;

// Moves starts by up to 0.05 m and 2 degrees and cruise by up to 2 %, as the scenario seed does.
Scenario Perturbed(Scenario scenario, std::uint32_t seed) {
  for (VehicleOptions& vehicle : scenario.vehicles) {
    Random random(seed, Number(vehicle.id));
    vehicle.start_world.position_world.x += random.Uniform(-0.05, 0.05);
    vehicle.start_world.position_world.y += random.Uniform(-0.05, 0.05);
    vehicle.start_world.heading_rad += Radians(random.Uniform(-2, 2));
    vehicle.cruise_m_s *= 1 + random.Uniform(-0.02, 0.02);
  }
  return scenario;
}

class CrossingTest : public testing::TestWithParam<Behaviour> {};

TEST_P(CrossingTest, TheSlowerHaltsTheFasterNeverAndBothArrive) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const auto outcome = Finish(Perturbed(Crossing(GetParam(), 0.4, 0.3), seed));
    ASSERT_EQ(outcome.figures.contacts, 0U) << "seed " << seed;
    ASSERT_EQ(outcome.halted, Ids{2}) << "seed " << seed;
    ASSERT_EQ(outcome.arrived, (Ids{1, 2})) << "seed " << seed;
  }
}

TEST_P(CrossingTest, OfEqualsExactlyTheHigherIdHalts) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const auto outcome = Finish(Perturbed(Crossing(GetParam(), 0.4, 0.4), seed));
    ASSERT_EQ(outcome.figures.contacts, 0U) << "seed " << seed;
    ASSERT_EQ(outcome.halted, Ids{2}) << "seed " << seed;
    ASSERT_EQ(outcome.arrived, (Ids{1, 2})) << "seed " << seed;
  }
}

TEST(CrossingOnce, WhenThePeerDiesTheOtherStopsAndGoesOnOnceTheWayIsClear) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    Scenario scenario = Perturbed(Crossing(Behaviour::kCooperative, 0.4, 0.3), seed);
    scenario.faults = {{FaultKind::kKill, VehicleId{2}, std::nullopt, 1.5}};
    const auto outcome = Finish(scenario);
    ASSERT_EQ(outcome.figures.contacts, 0U) << "seed " << seed;
    ASSERT_EQ(outcome.halted, Ids{1}) << "seed " << seed;
    ASSERT_EQ(outcome.arrived, Ids{1}) << "seed " << seed;
  }
}

// The number of decisions of one vehicle in a finished run: a stop that flickers shows as many.
int DecisionsOf(std::size_t index, const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  int decisions = 0;
  while (fleet.Advance()) decisions += fleet.OutputsOf(index).decision_changed ? 1 : 0;
  return decisions;
}

// cruise, give way, cruise, arrived; a cooperative one may brush the claim of the winner, which
// ends a little behind it, in its path: keep clear, cruise again
TEST_P(CrossingTest, TheLoserDoesNotFlickerOnceTheWinnerHasPassed) {
  const int brushes = GetParam() == Behaviour::kCooperative ? 2 : 0;
  EXPECT_LE(DecisionsOf(1, Crossing(GetParam(), 0.4, 0.3)), 4 + brushes);
}

// cruise, sensor only, peer lost, cruise, cooperative again or arrived
TEST(CrossingOnce, ALostPeerStopsItOnceAndFirmly) {
  Scenario scenario = Crossing(Behaviour::kCooperative, 0.4, 0.3);
  scenario.faults = {{FaultKind::kKill, VehicleId{2}, std::nullopt, 1.5}};
  EXPECT_LE(DecisionsOf(0, scenario), 6);
}

TEST(CrossingOnce, WhicheverDiesWheneverNobodyTouches) {
  for (std::uint32_t victim = 1; victim <= 2; ++victim) {
    for (int tenth = 1; tenth < 160; tenth += 3) {
      Scenario scenario = Crossing(Behaviour::kCooperative, 0.4, 0.3);
      scenario.faults = {{FaultKind::kKill, VehicleId{victim}, tenth * 0.1, std::nullopt}};
      const auto outcome = Finish(scenario);
      ASSERT_EQ(outcome.figures.contacts, 0U) << "vehicle " << victim << " at " << tenth * 0.1;
    }
  }
}

TEST(CrossingOnce, TheLecturesAvoidersPartWays) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    Scenario scenario =
        test::ScenarioOf({test::VehicleAt(1, Behaviour::kLectureAvoid, 0.195, {-2, 0}, 0, 0),
                          test::VehicleAt(2, Behaviour::kLectureAvoid, 0.195, {0, -2}, 90, 0)});
    scenario.duration_s = 15;
    scenario.expect.parted = true;
    const auto outcome = Finish(Perturbed(scenario, seed));
    ASSERT_TRUE(outcome.figures.passed) << "seed " << seed << ": " << outcome.figures.reason;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, CrossingTest,
                         testing::Values(Behaviour::kCooperative, Behaviour::kLectureYield),
                         [](const auto& test) { return std::string(Name(test.param)); });

}  // namespace
}  // namespace giveway

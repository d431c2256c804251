#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "sim_world/virtual/generators.h"
#include "tests/bench/baseline/pilot.h"
#include "tests/bench/baseline/reservation.h"
#include "tests/bench/baseline/rvo.h"

namespace giveway::bench {
namespace {

VehicleOptions Driving(std::uint32_t id, Vec2 from, Vec2 to, double cruise_m_s) {
  VehicleOptions options;
  options.id = VehicleId{id};
  options.profile = PioneerP3dx();
  options.cruise_m_s = cruise_m_s;
  options.goal = {.set = true, .at_world = to};
  options.start_world = {from, Atan2(to.y - from.y, to.x - from.x)};
  return options;
}

Scenario Place(std::vector<VehicleOptions> vehicles) {
  Scenario scenario;
  scenario.duration_s = 120;
  scenario.vehicles = std::move(vehicles);
  return scenario;
}

Crossed Reserve(const Scenario& scenario) {
  Reservation reservation(scenario);
  EXPECT_EQ(reservation.Refused(), 0U);
  return RunWithPilot(scenario, &reservation);
}

Crossed Avoid(const Scenario& scenario) {
  Rvo rvo(scenario);
  return RunWithPilot(scenario, &rvo);
}

class Alone : public testing::TestWithParam<double> {};

TEST_P(Alone, AVehicleWithAReservationIsThereAtTheFreeFlowTime) {
  const Crossed crossed = Reserve(Place({Driving(1, {0, 0}, {6, 8}, GetParam())}));
  ASSERT_EQ(crossed.arrived, 1U);
  EXPECT_GE(crossed.delays_s.front(), 0);
  EXPECT_LE(crossed.delays_s.front(), 0.2);
}

TEST_P(Alone, AVehicleWithNobodyToAvoidIsThereAtTheFreeFlowTime) {
  const Crossed crossed = Avoid(Place({Driving(1, {0, 0}, {6, 8}, GetParam())}));
  ASSERT_EQ(crossed.arrived, 1U);
  EXPECT_GE(crossed.delays_s.front(), 0);
  EXPECT_LE(crossed.delays_s.front(), 0.2);
}

INSTANTIATE_TEST_SUITE_P(Pilots, Alone, testing::Values(0.2, 0.31, 0.45, 0.6));

TEST(Reservation, TheFirstToComeIsNotDelayedAndTheSecondKeepsItsMargin) {
  const Crossed crossed =
      Reserve(Place({Driving(1, {-4, 0}, {4, 0}, 0.4), Driving(2, {0, -4.2}, {0, 4}, 0.4)}));
  ASSERT_EQ(crossed.arrived, 2U);
  EXPECT_LE(crossed.delays_s[0], 0.2);
  EXPECT_GT(crossed.delays_s[1], 0.3);
  EXPECT_GE(*crossed.separation_m, 0.1);
}

TEST(Reservation, NobodyTouchesAndEveryoneArrives) {
  for (const auto make : {sim::MakeCrossing, sim::MakeSwarm}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const Crossed crossed = Reserve(make({.vehicles = 12, .seed = seed}));
      EXPECT_EQ(crossed.arrived, 12U) << seed;
      EXPECT_EQ(crossed.contacts, 0U) << seed;
      EXPECT_GE(*crossed.separation_m, 0.07) << seed;
    }
  }
}

TEST(Rvo, TwoWhoMeetHeadOnPassEachOther) {
  const Crossed crossed =
      Avoid(Place({Driving(1, {-4, 0}, {4, 0}, 0.4), Driving(2, {4, 0}, {-4, 0}, 0.4)}));
  EXPECT_EQ(crossed.arrived, 2U);
  EXPECT_EQ(crossed.contacts, 0U);
}

TEST(Pilots, WhoeverDoesNotArriveCountsUntilTheEnd) {
  class Idle : public Pilot {
    void Drive(std::uint32_t, std::span<const Seen>, std::span<WheelSpeeds>) override {}
  };
  const Scenario scenario = Place({Driving(1, {0, 0}, {5, 0}, 0.5)});
  Idle idle;
  const Crossed crossed = RunWithPilot(scenario, &idle);
  EXPECT_EQ(crossed.arrived, 0U);
  ASSERT_EQ(crossed.delays_s.size(), 1U);
  EXPECT_NEAR(crossed.delays_s.front(), 120 - AloneSeconds(scenario.vehicles[0]), 1e-9);
}

}  // namespace
}  // namespace giveway::bench

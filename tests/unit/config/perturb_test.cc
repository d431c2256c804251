#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "services/config/scenario_overrides.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

Scenario Three() {
  Scenario scenario;
  for (const std::uint32_t id : {1U, 2U, 3U}) {
    VehicleOptions vehicle;
    vehicle.id = VehicleId{id};
    vehicle.cruise_m_s = 0.4;
    vehicle.start_world = {{1.0 * id, 2.0 * id}, 3.0};
    scenario.vehicles.push_back(vehicle);
  }
  return scenario;
}

Scenario Perturbed(Scenario scenario, std::uint32_t seed) {
  scenario.seed = seed;
  PerturbBySeed(&scenario);
  return scenario;
}

TEST(Perturb, SeedZeroMovesNothing) {
  const Scenario moved = Perturbed(Three(), 0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(moved.vehicles[i].start_world, Three().vehicles[i].start_world);
    EXPECT_EQ(moved.vehicles[i].cruise_m_s, 0.4);
  }
}

TEST(Perturb, EverySeedStaysWithinItsBoundsAndUsesThem) {
  double most_m = 0;
  double most_rad = 0;
  double most_m_s = 0;
  for (std::uint32_t seed = 1; seed <= 1000; ++seed) {
    const VehicleOptions moved = Perturbed(Three(), seed).vehicles[1];
    const VehicleOptions still = Three().vehicles[1];
    const Vec2 d = moved.start_world.position_world - still.start_world.position_world;
    most_m = std::max({most_m, std::abs(d.x), std::abs(d.y)});
    most_rad = std::max(most_rad, std::abs(WrapAngle(moved.start_world.heading_rad - 3.0)));
    most_m_s = std::max(most_m_s, std::abs(moved.cruise_m_s - 0.4));
  }
  EXPECT_LE(most_m, 0.05);
  EXPECT_GT(most_m, 0.049);
  EXPECT_LE(most_rad, Radians(2) + 1e-12);
  EXPECT_GT(most_rad, Radians(1.95));
  EXPECT_LE(most_m_s, 0.008 + 1e-12);
  EXPECT_GT(most_m_s, 0.0078);
}

TEST(Perturb, TheSameSeedMovesTheSameWay) {
  EXPECT_EQ(Perturbed(Three(), 7).vehicles[2].start_world,
            Perturbed(Three(), 7).vehicles[2].start_world);
  EXPECT_NE(Perturbed(Three(), 7).vehicles[2].start_world,
            Perturbed(Three(), 8).vehicles[2].start_world);
}

TEST(Perturb, AVehicleKeepsItsPlaceWhenAnotherIsAdded) {
  Scenario two = Three();
  two.vehicles.erase(two.vehicles.begin());
  EXPECT_EQ(Perturbed(two, 7).vehicles[1].start_world,
            Perturbed(Three(), 7).vehicles[2].start_world);
}

TEST(Perturb, CruiseNeverRisesAboveTheTopSpeed) {
  Scenario fast = Three();
  for (VehicleOptions& vehicle : fast.vehicles) vehicle.cruise_m_s = 1.0;
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    EXPECT_LE(Perturbed(fast, seed).vehicles[0].cruise_m_s, 1.0);
  }
}

}  // namespace
}  // namespace giveway

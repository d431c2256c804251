// The shipped fleets that drive until they are asked to stop, in virtual time with every place
// taken: in each minute each vehicle gets on, no two bodies touch, and no invariant is broken.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "services/fleetctl/virtual/virtual_case.h"
#include "sim_world/virtual/virtual_fleet.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {
namespace {

constexpr double kLeast_m = 4;  // in a minute, of 17 and more on a free road
constexpr int kMinutes = 10;
constexpr double kLoss_percent = 10;

struct Patrol {
  const char* scenario;
  std::uint32_t vehicles;
  std::uint32_t seed;
};

class ShippedPatrol : public testing::TestWithParam<Patrol> {};

// What each vehicle rolled in the next minute.
std::map<VehicleId, double> RollAMinute(sim::VirtualFleet* fleet) {
  std::map<VehicleId, double> rolled_m;
  std::map<VehicleId, Vec2> before;
  const double end_s = fleet->World().TimeSeconds() + 60;
  while (fleet->World().TimeSeconds() < end_s && fleet->Advance()) {
    for (const Truth& truth : fleet->World().Truths()) {
      const Vec2 now = truth.world_from_body.position_world;
      const auto [last, first] = before.try_emplace(truth.vehicle, now);
      rolled_m[truth.vehicle] += Norm(now - last->second);
      last->second = now;
    }
  }
  return rolled_m;
}

TEST_P(ShippedPatrol, EveryoneGetsOnInEveryMinute) {
  const Patrol& patrol = GetParam();
  const VirtualCase made = CaseMaker({.scenario = patrol.scenario,
                                      .vehicles = WholeRange{patrol.vehicles, patrol.vehicles},
                                      .duration_s = 60.0 * kMinutes})
                               .Make(patrol.seed);
  sim::VirtualFleet fleet(made.scenario, made.plan);
  for (int minute = 0; minute < kMinutes; ++minute) {
    const auto rolled_m = RollAMinute(&fleet);
    EXPECT_EQ(rolled_m.size(), patrol.vehicles);
    for (const auto& [vehicle, way_m] : rolled_m) {
      EXPECT_GT(way_m, kLeast_m) << "vehicle " << Number(vehicle) << ", minute " << minute;
    }
  }
  EXPECT_EQ(fleet.World().Contacts(), 0U);
}

TEST_P(ShippedPatrol, HoldsEveryInvariantWithLostBeacons) {
  const Patrol& patrol = GetParam();
  const VirtualCase made = CaseMaker({.scenario = patrol.scenario,
                                      .vehicles = WholeRange{patrol.vehicles, patrol.vehicles},
                                      .duration_s = 60.0 * kMinutes,
                                      .loss_percent = {kLoss_percent, kLoss_percent}})
                               .Make(patrol.seed);
  const sim::VirtualOutcome outcome = sim::RunVirtually(made.scenario, made.plan);
  EXPECT_EQ(outcome.vehicles, patrol.vehicles);
  EXPECT_TRUE(outcome.held);
  EXPECT_EQ(outcome.contacts, 0U);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, ShippedPatrol,
                         testing::Values(Patrol{"patrol", 8, 0}, Patrol{"patrol", 8, 3},
                                         Patrol{"patrol", 5, 1}, Patrol{"fleet_2", 8, 0},
                                         Patrol{"fleet_20", 24, 0}, Patrol{"warehouse_loop", 20, 0},
                                         Patrol{"warehouse_loop", 10, 1},
                                         Patrol{"city_grid", 32, 0}, Patrol{"city_grid", 16, 1},
                                         Patrol{"rush_hour", 16, 0}, Patrol{"rush_hour", 8, 1}),
                         [](const auto& test) {
                           return std::string(test.param.scenario) + "_of_" +
                                  std::to_string(test.param.vehicles) + "_seed_" +
                                  std::to_string(test.param.seed);
                         });

}  // namespace
}  // namespace giveway::fleetctl

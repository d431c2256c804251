#include "sim_world/run/roster.h"

#include <gtest/gtest.h>

#include "services/types/fleet_limits.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

JoinRequest Ask(std::uint32_t session, std::uint32_t wanted) {
  return {.session = {session, 0, 0, 1}, .wanted = VehicleId{wanted}};
}

Roster TwoPlaces() {
  return Roster(ScenarioOf({VehicleAt(3, {.position_world = {1, 0}}),
                            VehicleAt(5, {.position_world = {2, 0}, .heading_rad = 1})}),
                kEpoch);
}

TEST(Roster, GivesTheIdAskedForWithItsStartPose) {
  Roster roster = TwoPlaces();
  const RosterEntry entry = roster.Admit(Ask(1, 5));
  EXPECT_TRUE(entry.accepted);
  EXPECT_EQ(entry.session, Ask(1, 5).session);
  EXPECT_EQ(entry.vehicle, VehicleId{5});
  EXPECT_EQ(entry.start_world, (Pose{{2, 0}, 1}));
  EXPECT_EQ(entry.epoch, kEpoch);
  EXPECT_EQ(entry.fleet_size, 2U);
  EXPECT_EQ(entry.reason, "");
}

TEST(Roster, WhoeverAsksForAnyIdGetsTheLowestFreeOne) {
  Roster roster = TwoPlaces();
  EXPECT_EQ(roster.Admit(Ask(1, 0)).vehicle, VehicleId{3});
  EXPECT_EQ(roster.Admit(Ask(2, 0)).vehicle, VehicleId{5});
}

TEST(Roster, TheSameSessionGetsTheSameAnswerWhateverItAsksNext) {
  Roster roster = TwoPlaces();
  EXPECT_EQ(roster.Admit(Ask(1, 5)).vehicle, VehicleId{5});
  EXPECT_EQ(roster.Admit(Ask(1, 5)).vehicle, VehicleId{5});
  EXPECT_EQ(roster.Admit(Ask(1, 0)).vehicle, VehicleId{5});
  EXPECT_EQ(roster.Admit(Ask(2, 0)).vehicle, VehicleId{3});
}

TEST(Roster, AnIdOfAnotherSessionIsRefused) {
  Roster roster = TwoPlaces();
  roster.Admit(Ask(1, 5));
  const RosterEntry entry = roster.Admit(Ask(2, 5));
  EXPECT_FALSE(entry.accepted);
  EXPECT_EQ(entry.session, Ask(2, 5).session);
  EXPECT_EQ(entry.reason, "id 5 is taken by another session");
}

TEST(Roster, AnUnknownIdIsRefused) {
  Roster roster = TwoPlaces();
  const RosterEntry entry = roster.Admit(Ask(1, 4));
  EXPECT_FALSE(entry.accepted);
  EXPECT_EQ(entry.reason, "id 4 is not in the scenario");
}

TEST(Roster, AFullFleetTakesNobodyElse) {
  Roster roster = TwoPlaces();
  roster.Admit(Ask(1, 0));
  roster.Admit(Ask(2, 0));
  EXPECT_EQ(roster.Admit(Ask(3, 0)).reason, "the fleet is full");
}

// Regression: vehicles that the scenario names counted while they were absent.
TEST(Roster, AnOpenFleetIsFullOfVehiclesThatAreThereAndOfNoOthers) {
  constexpr std::uint32_t kNamed = 20;
  Scenario scenario = ScenarioOf({});
  for (std::uint32_t id = 1; id <= kNamed; ++id) scenario.vehicles.push_back(VehicleAt(id, {}));
  scenario.spawns = {VehicleAt(0, {})};
  Roster roster(scenario, kEpoch);
  for (std::uint32_t i = 1; i <= kMaxOpenFleet; ++i) {
    ASSERT_TRUE(roster.Admit(Ask(i, kNamed + i)).accepted) << i;
  }
  const RosterEntry one_more = roster.Admit(Ask(5000, 5000));
  EXPECT_FALSE(one_more.accepted);
  EXPECT_TRUE(one_more.waiting);
  EXPECT_EQ(one_more.reason, "the fleet is full");
  EXPECT_EQ(roster.Admit(Ask(5001, 1)).reason, "the fleet is full");
  roster.Free(VehicleId{kNamed + 1});
  EXPECT_TRUE(roster.Admit(Ask(5001, 1)).accepted);
}

// A patrolling vehicle passes its start again: another one starting there would fill the loop.
TEST(Roster, APlaceThatLoopsIsItsVehiclesForAsLongAsThatIsInTheRun) {
  Scenario scenario = ScenarioOf({});
  scenario.spawns = {VehicleAt(0, {.position_world = {1, 0}})};
  scenario.spawns[0].route = {.waypoints_world = {Vec2{5, 0}}, .count = 1, .loop = true};
  Roster roster(scenario, kEpoch);
  const VehicleId first = roster.Admit(Ask(1, 0)).vehicle;
  EXPECT_EQ(first, VehicleId{1});
  EXPECT_EQ(roster.Admit(Ask(2, 0)).reason, "no start place is free");
  roster.Free(first);
  EXPECT_TRUE(roster.Admit(Ask(2, 0)).accepted);
}

}  // namespace
}  // namespace giveway::sim

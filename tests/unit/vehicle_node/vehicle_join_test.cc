// The first place of a vehicle: which entries of the roster it takes.
#include "services/vehicle_node/vehicle_join.h"

#include <gmock/gmock.h>

#include "services/link/fastdds/link_options.h"
#include "tests/unit/vehicle_node/loop_bench.h"

namespace giveway::test {
namespace {

constexpr VehicleId kOne{1};

// A vehicle that is stopped after it has read the clock so often.
class Joining : public ::testing::Test {
 protected:
  Joining() {
    scenario_.vehicles = {DefaultOptions()};
    scenario_.vehicles.front().id = kOne;
  }
  RosterEntry At(double x_m) {
    RosterEntry entry = Entry(RunState::kRunning);
    entry.start_world.position_world.x = x_m;
    return entry;
  }
  JoinEnd EndOfJoiningAs(VehicleId wanted, int most_looks = 200) {
    int looks = 0;
    return Join(
        {.link = &link_, .clock = &clock_, .health = &health_, .scenario = &scenario_},
        [&] { return ++looks > most_looks; }, wanted, kSession);
  }
  std::optional<RosterEntry> JoinAs(VehicleId wanted) { return EndOfJoiningAs(wanted).entry; }

  HandClock clock_;
  ScriptedLink link_{&clock_, [](std::uint32_t) { return Arrival{}; }};
  VehicleHealthReporter health_{ServiceFlags{}};
  Scenario scenario_;
};

TEST_F(Joining, TakesThePlaceThatItIsGiven) {
  link_.Answer(At(1));
  const auto entry = JoinAs(kOne);
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->start_world.position_world.x, 1);
}

TEST_F(Joining, APlaceFarOffIsNotTakenAndAskedForAgain) {
  link_.Answer(At(1000));
  EXPECT_EQ(JoinAs(kOne), std::nullopt);
  EXPECT_GE(link_.SaidBesides().size(), 2U);
  link_.Answer(At(1000));
  link_.Answer(At(2));
  const auto entry = JoinAs(kNoVehicle);
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->start_world.position_world.x, 2);
}

// Regression: a vehicle that had driven straight on for 50 m was given no place any more.
TEST_F(Joining, WhatDrivesStraightOnMayBeAnywhere) {
  const auto why = [this](double x_m) { return WhyNoPlace(scenario_, At(x_m), kOne); };
  EXPECT_FALSE(why(1000).empty());
  scenario_.vehicles.front().goal.set = false;
  EXPECT_EQ(why(1000), "");
  Route& route = scenario_.vehicles.front().route;
  route.waypoints_world[route.count++] = {1, 1};
  EXPECT_EQ(why(1000), "");
  route.loop = true;
  EXPECT_FALSE(why(1000).empty());
}

TEST_F(Joining, AnotherIdThanTheOneWantedIsNotTaken) {
  link_.Answer(At(0));
  scenario_.vehicles.push_back(DefaultOptions());
  scenario_.vehicles.back().id = VehicleId{2};
  EXPECT_EQ(JoinAs(VehicleId{2}), std::nullopt);
}

TEST_F(Joining, AWorldWithAnotherScenarioIsAnErrorAtStart) {
  RosterEntry entry = At(0);
  entry.spawn = 3;
  link_.Answer(entry);
  EXPECT_THROW(JoinAs(kOne), link::LinkError);
}

// Regression: this was an exception, and so exit code 2, after which no supervisor starts it again.
TEST_F(Joining, WhoseInterfaceIsAnotherEndsToBeStartedAgain) {
  constexpr int kForMinutes = 10'000;
  EXPECT_FALSE(EndOfJoiningAs(kOne, kForMinutes).interface_lost);
  link_.ChangeInterface("the network interfaces changed");
  const JoinEnd end = EndOfJoiningAs(kOne, kForMinutes);
  EXPECT_TRUE(end.interface_lost);
  EXPECT_FALSE(end.entry);
}

TEST_F(Joining, ARefusalIsTheLastWord) {
  RosterEntry entry = At(1000);
  entry.accepted = false;
  entry.reason = "full";
  link_.Answer(entry);
  const auto last = JoinAs(kOne);
  ASSERT_TRUE(last);
  EXPECT_FALSE(last->accepted);
}

}  // namespace
}  // namespace giveway::test

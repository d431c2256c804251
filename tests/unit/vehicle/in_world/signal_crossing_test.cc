// Two vehicles and two traffic lights at a crossing, world and brains in memory: lights are obeyed,
// a vehicle at red does not block one with green, and without lights they give way.
#include <gtest/gtest.h>

#include "services/types/signal_plan.h"
#include "tests/support/crossing.h"
#include "tests/support/small_fleet.h"

namespace giveway {
namespace {

using test::SmallFleet;

constexpr double kLine_m = 0.7;  // from the crossing's middle

SignalPlan Head(std::uint32_t id, Vec2 along, double offset_s, double cycle_s) {
  const Vec2 middle = -kLine_m * along;
  return {.id = SignalId{id},
          .group = 1,
          .line_from_world = middle + 0.5 * Left(along),
          .line_to_world = middle - 0.5 * Left(along),
          .travel_rad = Atan2(along.y, along.x),
          .green_s = cycle_s / 2 - 3,
          .yellow_s = 3,
          .red_s = cycle_s / 2,
          .offset_s = offset_s};
}

// Vehicle 1 comes from the west and has green first; vehicle 2 comes from the south and stands at
// its line when vehicle 1 is there.
Scenario LitCrossing(double cruise_1_m_s, double cruise_2_m_s, double cycle_s) {
  Scenario scenario = test::Crossing(Behaviour::kCooperative, cruise_1_m_s, cruise_2_m_s);
  scenario.vehicles[0].start_world.position_world.x -= 1;
  scenario.signals = {Head(1, {1, 0}, 0, cycle_s), Head(2, {0, 1}, cycle_s / 2, cycle_s)};
  return scenario;
}

// How far the front of a vehicle's shell is beyond its stop line.
double BeyondLine(const SmallFleet& fleet, std::size_t i) {
  const Vec2 at = fleet.World().Truths()[i].world_from_body.position_world;
  return (i == 0 ? at.x : at.y) + 0.25 + kLine_m;
}

// It brakes there before it has arrived.
bool InGoal(const SmallFleet& fleet, std::size_t i) {
  const Truth& truth = fleet.World().Truths()[i];
  const Goal& goal = fleet.World().BodyOf(truth.vehicle)->goal;
  return Norm(goal.at_world - truth.world_from_body.position_world) <= goal.radius_m;
}

struct Seen {
  bool stood_on_green = false;    // vehicle 1, while 2 had red
  double went_over_at_s[2] = {};  // when the shell came over the line
  double red_s = 0;               // how long vehicle 2 said that a light stops it
};

Seen Drive(SmallFleet* fleet, const std::function<void(double time_s)>& each_tick = {}) {
  Seen seen;
  double before[2] = {-1, -1};
  bool going = true;
  while (going) {
    if (each_tick) each_tick(fleet->World().TimeSeconds());
    going = fleet->Advance();
    const double time_s = fleet->World().TimeSeconds();
    for (std::size_t i = 0; i < 2; ++i) {
      const double now = BeyondLine(*fleet, i);
      if (before[i] <= 0 && now > 0) seen.went_over_at_s[i] = time_s;
      before[i] = now;
    }
    const bool red = fleet->OutputsOf(1).command.decision.rule == Rule::kSignal;
    seen.red_s += red ? 0.05 : 0;
    const Truth& first = fleet->World().Truths()[0];
    seen.stood_on_green |=
        red && time_s > 2 && !first.arrived && !InGoal(*fleet, 0) && first.forward_m_s < 0.1;
  }
  return seen;
}

struct Speeds {
  double first_m_s;
  double second_m_s;
};

class LitCrossingTest : public testing::TestWithParam<Speeds> {
 protected:
  Scenario Lit(double cycle_s) const {
    return LitCrossing(GetParam().first_m_s, GetParam().second_m_s, cycle_s);
  }
};

// Even where the vehicle at red has priority by its key.
TEST_P(LitCrossingTest, RedStopsBeforeTheLineAndGreenIsNotBlocked) {
  const Scenario scenario = Lit(60);
  SmallFleet fleet(scenario);
  const Seen seen = Drive(&fleet);
  EXPECT_EQ(fleet.World().Figures().contacts, 0U);
  EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U);
  EXPECT_EQ(fleet.Count(EventKind::kHalted), 0U);
  EXPECT_FALSE(seen.stood_on_green);
  EXPECT_GT(seen.red_s, 5);
  EXPECT_LT(seen.went_over_at_s[0], 27);
  EXPECT_GT(seen.went_over_at_s[1], 30);
  EXPECT_LT(seen.went_over_at_s[1], 32);
}

TEST_P(LitCrossingTest, LightsThatGoDarkLeaveThemToGiveWay) {
  // Vehicle 2's red would last for an hour; both have reached the crossing when the lights fail.
  const Scenario scenario = Lit(7200);
  SmallFleet fleet(scenario);
  const Seen seen = Drive(&fleet, [&fleet](double time_s) {
    if (time_s < 8) return;
    fleet.Heads().Fail(SignalId{1}, FaultKind::kSignalDark);
    fleet.Heads().Fail(SignalId{2}, FaultKind::kSignalDark);
  });
  EXPECT_EQ(fleet.World().Figures().contacts, 0U);
  EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U);
  EXPECT_GT(seen.went_over_at_s[1], 8);
}

TEST_P(LitCrossingTest, SilentLightsAreNoLights) {
  const Scenario scenario = Lit(7200);
  SmallFleet fleet(scenario);
  Drive(&fleet, [&fleet](double time_s) {
    if (time_s < 9) return;
    fleet.Heads().Fail(SignalId{1}, FaultKind::kSignalSilent);
    fleet.Heads().Fail(SignalId{2}, FaultKind::kSignalSilent);
  });
  EXPECT_EQ(fleet.World().Figures().contacts, 0U);
  EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U);
}

// Only the red light fails, at every moment in turn: its vehicle gives way as usual.
TEST_P(LitCrossingTest, OneLightThatFailsAtAnyMomentEndsInNoContact) {
  for (int tenths = 20; tenths < 220; tenths += 4) {
    const Scenario scenario = Lit(7200);
    SmallFleet fleet(scenario);
    Drive(&fleet, [&](double time_s) {
      if (time_s >= 0.1 * tenths) fleet.Heads().Fail(SignalId{2}, FaultKind::kSignalDark);
    });
    EXPECT_EQ(fleet.World().Figures().contacts, 0U) << tenths;
    EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U) << tenths;
    EXPECT_GT(*fleet.World().Figures().min_separation_m, 0.1) << tenths;
  }
}

// The lights change while vehicle 1 is anywhere in the crossing: it leaves first.
TEST_P(LitCrossingTest, WhoeverIsInsideWhenTheLightsChangeGoesFirst) {
  for (int seconds = 12; seconds < 60; seconds += 2) {
    const Scenario scenario = Lit(seconds);
    SmallFleet fleet(scenario);
    Drive(&fleet);
    EXPECT_EQ(fleet.World().Figures().contacts, 0U) << seconds;
    EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U) << seconds;
    EXPECT_GT(*fleet.World().Figures().min_separation_m, 0.1) << seconds;
  }
}

// No vehicle crosses a line on red, whatever the cycle.
TEST_P(LitCrossingTest, NobodyGoesOverALineOnRed) {
  for (int seconds = 12; seconds < 60; seconds += 3) {
    const Scenario scenario = Lit(seconds);
    SmallFleet fleet(scenario);
    const Seen seen = Drive(&fleet);
    for (std::size_t i = 0; i < 2; ++i) {
      // A decision takes effect two ticks after its inputs.
      const Nanoseconds over = FromSeconds(seen.went_over_at_s[i] - 0.1);
      EXPECT_NE(PhaseAt(scenario.signals[i], over).phase, SignalPhase::kRed)
          << seconds << " vehicle " << i + 1;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Order, LitCrossingTest,
                         testing::Values(Speeds{0.4, 0.3}, Speeds{0.3, 0.4}, Speeds{0.3, 0.3}),
                         [](const auto& test) {
                           return test.param.first_m_s > test.param.second_m_s   ? "GreenFirst"
                                  : test.param.first_m_s < test.param.second_m_s ? "RedFirst"
                                                                                 : "Equal";
                         });

// Vehicle 2 passes a waypoint up to 0.3 m before it, and needs 0.6 m to stand.
TEST(LitCrossing, ARedLightJustBehindAWaypointStopsInTime) {
  for (const double behind_m : {0.05, 0.15, 0.3, 0.45, 0.6}) {
    Scenario scenario = LitCrossing(0.3, 0.8, 60);
    scenario.vehicles[1].route.count = 1;
    scenario.vehicles[1].route.waypoints_world[0] = {0, -kLine_m - behind_m};
    SmallFleet fleet(scenario);
    const Seen seen = Drive(&fleet);
    EXPECT_EQ(fleet.Count(EventKind::kArrived), 2U) << behind_m;
    EXPECT_GT(seen.went_over_at_s[1], 30) << behind_m;
  }
}

// A second vehicle on the same path stands behind the first at red and does not overtake it.
TEST(LitCrossing, AQueueAtRedStaysAQueue) {
  Scenario scenario = LitCrossing(0.3, 0.3, 60);
  scenario.vehicles.push_back(test::VehicleAt(3, Behaviour::kCooperative, 0.3, {0, -5.5}, 90, 7.0));
  SmallFleet fleet(scenario);
  double least_gap_m = 1e9;
  while (fleet.Advance()) {
    const double ahead = fleet.World().Truths()[1].world_from_body.position_world.y;
    const double behind = fleet.World().Truths()[2].world_from_body.position_world.y;
    least_gap_m = std::min(least_gap_m, ahead - behind - 0.5);
    EXPECT_NEAR(fleet.World().Truths()[2].world_from_body.position_world.x, 0, 0.1);
  }
  EXPECT_GT(least_gap_m, 0.05);
  EXPECT_EQ(fleet.World().Figures().contacts, 0U);
  EXPECT_EQ(fleet.Count(EventKind::kArrived), 3U);
}

}  // namespace
}  // namespace giveway

// How one brain reacts to traffic lights, phase by phase and edge by edge, on the bench.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/vehicle/estimation/signal_table.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;
using test::kEpoch;

// A head for eastbound traffic whose line crosses the x axis at `x_m`.
SignalState Head(SignalPhase phase, double x_m, double travel_rad = 0, std::uint32_t id = 1) {
  return {.id = SignalId{id},
          .epoch = kEpoch,
          .tick = Tick{1},
          .line_from_world = {x_m, 1},
          .line_to_world = {x_m, -1},
          .travel_rad = travel_rad,
          .phase = phase,
          .to_change_s = 5};
}

RangeScan Driving(double speed_m_s) {
  RangeScan scan = ClearScan(0);
  scan.wheels = {speed_m_s / 0.0975, speed_m_s / 0.0975};
  return scan;
}

// One step that drives at `speed_m_s` and hears this head; the vehicle starts at the origin.
Outputs Hear(BrainBench* bench, const SignalState& head, double speed_m_s) {
  bench->WithNext().signals = {head};
  return bench->Step(Driving(speed_m_s));
}

double TargetSpeed(const Outputs& out) {
  return TwistFromWheels(DriveGeometry{}, out.command.target).forward_m_s;
}

TEST(SignalsObeyed, RedStopsWithinTheDistanceToTheLine) {
  BrainBench bench(test::DefaultOptions());
  const Outputs out = Hear(&bench, Head(SignalPhase::kRed, 0.6), 0.0);
  EXPECT_EQ(out.command.decision.rule, Rule::kSignal);
  EXPECT_EQ(out.command.decision.cause_tick, Tick{1});
  // The shell is 0.35 m before the line, and stays 0.15 m away from it.
  EXPECT_NEAR(TargetSpeed(out), std::min(0.3, SpeedToStopWithin(0.2, 0.1, 0.6)), 1e-12);
  EXPECT_EQ(TargetSpeed(Hear(&bench, Head(SignalPhase::kRed, 0.39), 0.0)), 0);
}

TEST(SignalsObeyed, RedIsToldFromFarOnAndCostsNoSpeedThere) {
  BrainBench bench(test::DefaultOptions());
  const Outputs out = Hear(&bench, Head(SignalPhase::kRed, 2.5), 0.3);
  EXPECT_EQ(out.beacon.rule, Rule::kSignal);
  EXPECT_NEAR(TargetSpeed(out), 0.3, 1e-12);
  const Outputs far = Hear(&bench, Head(SignalPhase::kRed, 4), 0.3);
  EXPECT_EQ(far.beacon.rule, Rule::kCruise);  // who knows what lies between
}

TEST(SignalsObeyed, OverTheLineItGoesOn) {
  BrainBench bench(test::DefaultOptions());
  EXPECT_EQ(Hear(&bench, Head(SignalPhase::kRed, 0.24), 0).command.decision.rule, Rule::kCruise);
  EXPECT_EQ(Hear(&bench, Head(SignalPhase::kRed, -1), 0).command.decision.rule, Rule::kCruise);
}

TEST(SignalsObeyed, OnlyAHeadOnThePathInTheDirectionOfTravelMatters) {
  BrainBench bench(test::DefaultOptions());
  const auto rule = [&](double x_m, double travel_deg, double goal_off = 0) {
    SignalState head = Head(SignalPhase::kRed, x_m, WrapAngle(Radians(travel_deg)));
    head.line_from_world.y += goal_off;
    head.line_to_world.y += goal_off;
    return Hear(&bench, head, 0).command.decision.rule;
  };
  EXPECT_EQ(rule(0.5, 0), Rule::kSignal);
  EXPECT_EQ(rule(0.5, 44), Rule::kSignal);
  EXPECT_EQ(rule(0.5, -44), Rule::kSignal);
  EXPECT_EQ(rule(0.5, 46), Rule::kCruise);
  EXPECT_EQ(rule(0.5, 180), Rule::kCruise);
  EXPECT_EQ(rule(0.5, 0, 1.1), Rule::kCruise);  // the line ends next to the path
  EXPECT_EQ(rule(11, 0), Rule::kCruise);        // behind the goal
}

// A vehicle at 0.8 m/s needs 0.61 m to stand, and passes a waypoint at 0.3 m before it.
class BehindAWaypoint : public testing::Test {
 protected:
  // At 0.6 m, 0.4 m before a waypoint, from where the path continues to `next`.
  BehindAWaypoint() : options_(test::DefaultOptions()) { options_.cruise_m_s = 0.8; }
  Outputs Approach(std::vector<Vec2> next, const SignalState& head) {
    options_.route.waypoints_world[options_.route.count++] = {1, 0};
    options_.goal.at_world = next.back();
    next.pop_back();
    for (const Vec2 at : next) options_.route.waypoints_world[options_.route.count++] = at;
    BrainBench bench(options_);
    for (int i = 0; i < 14; ++i) bench.Step(Driving(0.8));
    return Hear(&bench, head, 0.8);
  }

  VehicleOptions options_;
};

TEST_F(BehindAWaypoint, RedStopsInTimeWhereThePathGoesOn) {
  const Outputs out = Approach({{10, 0}}, Head(SignalPhase::kRed, 1.4));
  EXPECT_EQ(out.command.decision.rule, Rule::kSignal);
  EXPECT_NEAR(TargetSpeed(out), SpeedToStopWithin(1.4 - 0.6 - 0.25 - 0.15, 0.1, 0.6), 1e-9);
}

TEST_F(BehindAWaypoint, RedStopsInTimePastShortLegs) {
  const Outputs out = Approach({{1.15, 0}, {1.3, 0}, {10, 0}}, Head(SignalPhase::kRed, 1.4));
  EXPECT_EQ(out.command.decision.rule, Rule::kSignal);
  EXPECT_NEAR(TargetSpeed(out), SpeedToStopWithin(0.4, 0.1, 0.6), 1e-9);
}

TEST_F(BehindAWaypoint, RedStopsAlongABend) {
  const Outputs out = Approach({{9, 4}}, Head(SignalPhase::kRed, 1.4));
  EXPECT_EQ(out.command.decision.rule, Rule::kSignal);
}

TEST_F(BehindAWaypoint, ALineThatThePathTurnsAwayFromIsNone) {
  const Outputs out = Approach({{1, 9}}, Head(SignalPhase::kRed, 1.4));
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
}

TEST_F(BehindAWaypoint, ALineBehindTheGoalIsNone) {
  const Outputs out = Approach({{1.1, 0}}, Head(SignalPhase::kRed, 1.4));
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
}

// Further on there will be time enough once the waypoint is passed: until then its beacons say
// nothing of it.
TEST_F(BehindAWaypoint, ALineFarBehindItIsNoneYet) {
  const Outputs out = Approach({{10, 0}}, Head(SignalPhase::kRed, 2.5));
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
}

TEST(SignalsObeyed, GreenAndDarkHoldNobody) {
  BrainBench bench(test::DefaultOptions());
  EXPECT_EQ(Hear(&bench, Head(SignalPhase::kGreen, 0.5), 0).command.decision.rule, Rule::kCruise);
  EXPECT_EQ(Hear(&bench, Head(SignalPhase::kDark, 0.5), 0).command.decision.rule, Rule::kCruise);
}

TEST(SignalsObeyed, OnGreenEverythingElseStillHolds) {
  BrainBench bench(test::DefaultOptions());
  RangeScan scan = Driving(0.3);
  test::SetEcho(&scan, 3, 0.2);
  bench.WithNext().signals = {Head(SignalPhase::kGreen, 0.5)};
  EXPECT_EQ(bench.Step(scan).command.decision.rule, Rule::kObstacle);
}

// From 0.3 m/s it takes 0.03 m to react and 0.075 m to brake.
TEST(SignalsObeyed, YellowStopsWhoCanAndLetsGoWhoCannot) {
  BrainBench can(test::DefaultOptions());
  can.Step(Driving(0.3));                                           // at 0.015 m
  Outputs out = Hear(&can, Head(SignalPhase::kYellow, 0.39), 0.3);  // shell 0.11 m before it
  EXPECT_EQ(out.command.decision.rule, Rule::kSignal);
  EXPECT_EQ(TargetSpeed(out), 0);

  BrainBench cannot(test::DefaultOptions());
  cannot.Step(Driving(0.3));
  out = Hear(&cannot, Head(SignalPhase::kYellow, 0.38), 0.3);  // shell 0.10 m before it
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  EXPECT_NEAR(TargetSpeed(out), 0.3, 1e-12);
}

// Braking takes a tick to act: the decision must not change back in between.
TEST(SignalsObeyed, AYellowIsDecidedOnOnce) {
  BrainBench bench(test::DefaultOptions());
  bench.Step(Driving(0.3));
  for (int i = 0; i < 2; ++i) {
    const Outputs out = Hear(&bench, Head(SignalPhase::kYellow, 0.39), 0.3);
    EXPECT_EQ(out.command.decision.rule, Rule::kSignal) << i;
  }
  // The next yellow is another one.
  Hear(&bench, Head(SignalPhase::kGreen, 0.39), 0.3);
  EXPECT_EQ(Hear(&bench, Head(SignalPhase::kYellow, 0.39), 0.3).command.decision.rule,
            Rule::kCruise);
}

TEST(SignalsObeyed, AHeadNotHeardFor300MillisecondsIsNone) {
  BrainBench bench(test::DefaultOptions());
  Outputs out = Hear(&bench, Head(SignalPhase::kRed, 0.5), 0);
  for (int i = 0; i < 6; ++i) {
    out = bench.Step(Driving(0));
    EXPECT_EQ(out.command.decision.rule, Rule::kSignal) << i;
  }
  EXPECT_EQ(bench.Step(Driving(0)).command.decision.rule, Rule::kCruise);
}

TEST(SignalsObeyed, TheLecturesBehavioursKnowNoLights) {
  for (const Behaviour behaviour :
       {Behaviour::kLectureAvoid, Behaviour::kStockAvoid, Behaviour::kLectureYield}) {
    VehicleOptions options = test::DefaultOptions();
    options.behaviour = behaviour;
    BrainBench bench(options);
    EXPECT_EQ(Hear(&bench, Head(SignalPhase::kRed, 0.5), 0).command.decision.rule, Rule::kCruise);
  }
}

TEST(SignalsObeyed, NonsenseAndOtherWorldsAreRefusedAndCounted) {
  BrainBench bench(test::DefaultOptions());
  bench.Step(ClearScan(0));
  std::vector<SignalState> bad(5, Head(SignalPhase::kRed, 0.5));
  bad[0].line_from_world.x = std::numeric_limits<double>::quiet_NaN();
  bad[1].travel_rad = 40;
  bad[2].id = kNoSignal;
  bad[3].phase = static_cast<SignalPhase>(9);
  bad[4].line_to_world.y = std::numeric_limits<double>::infinity();
  for (const SignalState& signal : bad) {
    EXPECT_EQ(Hear(&bench, signal, 0).command.decision.rule, Rule::kCruise);
  }
  EXPECT_EQ(bench.Brain().State().counters.signals_refused, 5U);
}

// ---- the table

constexpr SteadyTime At(int milliseconds) { return std::chrono::milliseconds(milliseconds); }
const Approach kAhead{
    .path = {{0, 0}, {1, 0}}, .distance_to_goal_m = 100, .body_radius_m = 0.25, .stopping_m = 0.1};

constexpr Vec2 kHere{0, 0};

TEST(SignalTable, HoldsThirtyTwoHeadsAndLetsASilentOneGo) {
  SignalTable table;
  for (std::uint32_t id = 1; id <= kMaxSignals; ++id) {
    EXPECT_TRUE(table.Take(Head(SignalPhase::kRed, 40.0 - id, 0, id), kEpoch, At(0), kHere));
  }
  EXPECT_EQ(table.MustStopAt(kAhead, At(0))->signal, SignalId{32});  // the nearest
  EXPECT_FALSE(table.Take(Head(SignalPhase::kRed, 50, 0, 99), kEpoch, At(300), kHere));
  EXPECT_TRUE(table.Take(Head(SignalPhase::kRed, 50, 0, 99), kEpoch, At(301), kHere));
  EXPECT_EQ(table.MustStopAt(kAhead, At(301))->signal, SignalId{99});
}

TEST(SignalTable, KeepsTheNearestHeadsOfMoreThanItHolds) {
  SignalTable table;
  const auto take = [&](double x_m, std::uint32_t id, Vec2 own_world) {
    return table.Take(Head(SignalPhase::kRed, x_m, 0, id), kEpoch, At(0), own_world);
  };
  for (std::uint32_t id = 1; id <= kMaxSignals; ++id) EXPECT_TRUE(take(50.0 + id, id, kHere));
  EXPECT_FALSE(take(90, 98, kHere));
  EXPECT_TRUE(take(2, 99, kHere));
  EXPECT_EQ(table.MustStopAt(kAhead, At(0))->signal, SignalId{99});
  EXPECT_EQ(table.Heard(), kMaxSignals);
  EXPECT_FALSE(take(82, 32, kHere)) << "it was the farthest, and had to go";
  EXPECT_TRUE(take(82, 32, {80, 0})) << "from there the one at 2 m is the farthest";
  EXPECT_FALSE(take(2, 99, {80, 0}));
}

// By the line, not by one of its ends: the middle of a long one may be the nearest of all.
TEST(SignalTable, KeepsALongLineWhoseEndsAreFarOff) {
  SignalTable table;
  SignalState wide = Head(SignalPhase::kRed, 2, 0, 99);
  wide.line_from_world.y = 80;
  wide.line_to_world.y = -80;
  EXPECT_TRUE(table.Take(wide, kEpoch, At(0), kHere));
  for (std::uint32_t id = 1; id <= kMaxSignals; ++id) {
    const SignalState head = Head(SignalPhase::kRed, 10.0 + id, 0, id);
    EXPECT_EQ(table.Take(head, kEpoch, At(0), kHere), id < kMaxSignals) << id;
  }
  EXPECT_EQ(table.MustStopAt(kAhead, At(0))->signal, SignalId{99});
}

TEST(SignalTable, OldNewsAndOtherWorldsAreRefused) {
  SignalTable table;
  SignalState red = Head(SignalPhase::kRed, 2);
  red.tick = Tick{10};
  SignalState green = Head(SignalPhase::kGreen, 2);
  green.tick = Tick{9};
  EXPECT_TRUE(table.Take(red, kEpoch, At(0), kHere));
  EXPECT_FALSE(table.Take(green, kEpoch, At(10), kHere));
  EXPECT_TRUE(table.MustStopAt(kAhead, At(10)).has_value());
  green.tick = Tick{11};
  EXPECT_FALSE(table.Take(green, WorldEpoch{8}, At(20), kHere));
  EXPECT_FALSE(table.Take(green, kNoEpoch, At(20), kHere));
  EXPECT_TRUE(table.Take(green, kEpoch, At(20), kHere));
  EXPECT_FALSE(table.MustStopAt(kAhead, At(20)).has_value());
}

// ---- what others' lights mean

// A peer that stands south of the own path, heading across it, and has priority by its key.
Beacon Southern(std::uint32_t tick, Rule rule, double south_m = 1.0) {
  Beacon beacon =
      BeaconOf(2, tick, {.position_world = {1.5, -south_m}, .heading_rad = kPi / 2}, 0.6);
  beacon.rule = rule;
  return beacon;
}

TEST(SignalsOfOthers, WhoStandsAtRedComesAfterWhoDoesNot) {
  for (const Rule rule : {Rule::kSignal, Rule::kCruise}) {
    BrainBench bench(test::OptionsWithoutUltrasonics());
    Outputs out = bench.Step(Driving(0.3));
    for (std::uint32_t tick = 2; tick < 50; ++tick) {
      out = bench.Step(Driving(0.3), {Southern(tick - 1, rule)});
      if (rule == Rule::kSignal) {
        EXPECT_EQ(out.command.decision.rule, Rule::kCruise) << tick;
        EXPECT_EQ(out.beacon.gives_way_to, kNoVehicle) << tick;
      }
    }
    EXPECT_EQ(out.command.decision.rule, rule == Rule::kSignal ? Rule::kCruise : Rule::kGiveWay);
  }
}

// A red light for a peer is no licence to drive into it if it cannot stop for that light.
TEST(SignalsOfOthers, APeerThatCouldNotStopAnyMoreIsNotCountedOn) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  Outputs out;
  for (std::uint32_t tick = 1; tick < 54; ++tick) {
    Beacon beacon = Southern(tick - 1, Rule::kSignal, 0.75);
    beacon.wheels = {0.5 / 0.0975, 0.5 / 0.0975};
    std::vector<Beacon> beacons;
    if (tick > 1) beacons = {beacon};
    out = bench.Step(Driving(0.3), beacons);
  }
  EXPECT_EQ(out.command.decision.rule, Rule::kNotGranted);
}

// Its light is red, and it rolls up slowly; but it stops by its own brakes, not by this vehicle's.
TEST(SignalsOfOthers, APeerWithWeakBrakesIsNotCountedOn) {
  for (const double deceleration_m_s2 : {0.6, 0.05}) {
    BrainBench bench(test::OptionsWithoutUltrasonics());
    Outputs out;
    for (std::uint32_t tick = 1; tick < 54; ++tick) {
      Beacon beacon = Southern(tick - 1, Rule::kSignal, 0.9);
      beacon.wheels = {0.2 / 0.0975, 0.2 / 0.0975};
      beacon.deceleration_m_s2 = deceleration_m_s2;
      out = bench.Step(Driving(0.3), tick == 1 ? std::vector<Beacon>{} : std::vector{beacon});
    }
    EXPECT_EQ(out.command.decision.rule,
              deceleration_m_s2 < 0.1 ? Rule::kNotGranted : Rule::kCruise);
  }
}

// Both stood at red, and both lights fail at the same time: what the other's beacon said about its
// light a tick ago is no reason to go now.
TEST(SignalsOfOthers, OfTwoThatLightsStoppedNeitherCountsOnTheOthersLight) {
  VehicleOptions options = test::DefaultOptions();
  options.cruise_m_s = 0.8;  // first in the order
  BrainBench bench(options);
  // On to 0.87 m; the conflict with the path at x = 1.5 starts three centimetres further on.
  bench.Step(ClearScan(0));
  for (int i = 0; i < 29; ++i) bench.Step(Driving(0.6));
  for (int i = 0; i < 2; ++i) {
    const Beacon other = Southern(bench.NextTick() - 1, Rule::kSignal, 0.8);
    bench.WithNext().signals = {Head(SignalPhase::kRed, 1.17)};
    EXPECT_EQ(bench.Step(Driving(0), {other}).command.decision.rule, Rule::kSignal);
  }
  Beacon other = Southern(bench.NextTick() - 1, Rule::kSignal, 0.8);
  other.wheels = {0.3, 0.3};  // creeps: one that stands would be a body and no path
  bench.WithNext().signals = {Head(SignalPhase::kDark, 1.17)};
  const Outputs out = bench.Step(Driving(0), {other});
  EXPECT_EQ(out.command.decision.rule, Rule::kNotGranted);
  EXPECT_FALSE(bench.Brain().State().heard.peers.Peers()[0].encounter.entered);
}

TEST(SignalsOfOthers, AQueueAtALightIsNotOvertaken) {
  for (const Rule rule : {Rule::kSignal, Rule::kArrived}) {
    BrainBench bench(test::DefaultOptions());
    Beacon ahead = BeaconOf(2, 1, {.position_world = {2, 0}}, 0.2);
    ahead.rule = rule;
    bench.Step(ClearScan(0));
    const Outputs out = bench.Step(Driving(0.3), {ahead});
    EXPECT_EQ(out.command.decision.rule, rule == Rule::kSignal ? Rule::kCruise : Rule::kSteerRound);
  }
}

}  // namespace
}  // namespace giveway

#include "services/vehicle/decision/steering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "services/types/math/math.h"
#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

RangeView Seeing(int sensor, double range_m) {
  RangeScan scan = test::ClearScan(1);
  test::SetEcho(&scan, sensor, range_m);
  RangeView view;
  view.Take(scan, milliseconds(50), milliseconds(50));
  return view;
}

TEST(Steering, ActivationIsOneAtTheNearGateAndNothingAtTheFarOne) {
  const BraitenbergWeights lecture = LectureWeights();
  EXPECT_EQ(Avoid(lecture, Seeing(1, 1.0)).wheels, (WheelSpeeds{2, 2}));
  EXPECT_NEAR(Avoid(lecture, Seeing(1, 0.6)).wheels.left_rad_s, 2.5, 1e-12);
  EXPECT_NEAR(Avoid(lecture, Seeing(1, 0.2)).wheels.left_rad_s, 3, 1e-12);
  EXPECT_NEAR(Avoid(lecture, Seeing(1, 0.05)).wheels.left_rad_s, 3, 1e-12);
}

TEST(Steering, TheLecturesVehicleTurnsAwayFromEitherSide) {
  const BraitenbergWeights lecture = LectureWeights();
  const WheelSpeeds left = Avoid(lecture, Seeing(1, 0.4)).wheels;
  const WheelSpeeds right = Avoid(lecture, Seeing(6, 0.4)).wheels;
  EXPECT_GT(left.left_rad_s, left.right_rad_s);  // object on the left: turns right
  EXPECT_EQ(left.left_rad_s, right.right_rad_s);
  EXPECT_EQ(left.right_rad_s, right.left_rad_s);
}

// The rule of a vehicle that drives two metres east, after a beacon from one that has arrived in
// its path.
Rule RuleBefore(double x_m) {
  VehicleOptions options = test::OptionsWithoutUltrasonics();
  options.goal.at_world = {2, 0};
  test::BrainBench bench(options);
  bench.Step(test::ClearScan(0));
  Beacon peer = test::BeaconOf(2, 1, {.position_world = {x_m, 0.01}});
  peer.toward_world = peer.world_from_body.position_world;
  peer.rule = Rule::kArrived;
  return bench.Step(test::ClearScan(0), {peer}).command.decision.rule;
}

TEST(Steering, WhoeverStandsOnTheVeryGoalIsWaitedForAndNotSteeredRound) {
  EXPECT_EQ(RuleBefore(1), Rule::kSteerRound);
  EXPECT_NE(RuleBefore(2), Rule::kSteerRound);
}

// The stock script's table for base 2 rad/s: sensor 4 alone gives 1.2 and 1.0.
TEST(Steering, TheStockVehicleBrakesAndTurnsAway) {
  const WheelSpeeds wheels = Avoid(StockWeights(), Seeing(3, 0.1)).wheels;
  EXPECT_NEAR(wheels.left_rad_s, 1.2, 1e-12);
  EXPECT_NEAR(wheels.right_rad_s, 1.0, 1e-12);
}

TEST(Steering, ALargeErrorTurnsOnTheSpotFirst) {
  const RobotModel p3dx = PioneerP3dx();
  const WheelSpeeds wheels = Drive(p3dx, {}, {.heading_error_rad = 0.5}, {0.3, true, 0.05});
  EXPECT_NEAR(wheels.left_rad_s, -wheels.right_rad_s, 1e-12);
  EXPECT_GT(wheels.right_rad_s, 0);
}

TEST(Steering, ADeadStopDoesNotTurn) {
  EXPECT_EQ(Drive(PioneerP3dx(), {}, {.heading_error_rad = 0.5}, {0, false, 0.05}), WheelSpeeds{});
}

// The rim of a wheel after one tick of 50 ms towards `target`, radians a second.
double RimAfterTick(const RobotModel& profile, double now, double target) {
  const double limit = 0.05 * profile.acceleration_m_s2 / profile.drive.wheel_radius_m;
  return now + std::clamp(target - now, -limit, limit);
}

// The same where it brakes: towards standstill, and through it.
double BrakedOrFaster(const RobotModel& profile, double now, double target) {
  const bool brakes = now * target < 0 || std::abs(target) < std::abs(now);
  if (!brakes) return RimAfterTick(profile, now, target);
  const double limit = 0.05 * profile.deceleration_m_s2 / profile.drive.wheel_radius_m;
  return now + std::clamp((now * target < 0 ? 0 : target) - now, -limit, limit);
}

TEST(Steering, AVehicleThatSpeedsUpOutOfATurnDoesNotSway) {
  const RobotModel p3dx = PioneerP3dx();
  WheelSpeeds wheels;
  double error_rad = 1;
  double most_rad = 0;  // beyond the wanted heading
  for (int tick = 0; tick < 100; ++tick) {
    const Twist now = TwistFromWheels(p3dx.drive, wheels);
    const WheelSpeeds target =
        Drive(p3dx, now, {.heading_error_rad = error_rad}, {0.8, true, 0.05});
    error_rad -= 0.05 * now.turn_rad_s;
    wheels = {RimAfterTick(p3dx, wheels.left_rad_s, target.left_rad_s),
              RimAfterTick(p3dx, wheels.right_rad_s, target.right_rad_s)};
    most_rad = std::max(most_rad, -error_rad);
  }
  EXPECT_LT(most_rad, 0.15);
  EXPECT_NEAR(error_rad, 0, 0.02);
  EXPECT_NEAR(TwistFromWheels(p3dx.drive, wheels).forward_m_s, 0.8, 1e-9);
}

// Regression: one rim speeds up ten times as fast as the other brakes. Steering away from what it
// had to stop for made it drive on, faster and faster, until both touched.
TEST(Steering, ATurnMakesNobodyFasterThanItMayDrive) {
  RobotModel weak = PioneerP3dx();
  weak.acceleration_m_s2 = 2;
  weak.deceleration_m_s2 = 0.2;
  for (const double error_rad : {0.05, -0.1, 0.25, -0.6, 1.5}) {
    WheelSpeeds wheels = WheelsFromTwist(weak.drive, {0.3, 0});
    WheelSpeeds straight = wheels;
    for (int tick = 0; tick < 60; ++tick) {
      const Twist now = TwistFromWheels(weak.drive, wheels);
      const auto after = [&](WheelSpeeds from, WheelSpeeds to) {
        return WheelSpeeds{BrakedOrFaster(weak, from.left_rad_s, to.left_rad_s),
                           BrakedOrFaster(weak, from.right_rad_s, to.right_rad_s)};
      };
      wheels = after(wheels, Drive(weak, now, {.heading_error_rad = error_rad}, {0, true, 0.05}));
      straight = after(straight, {});
      ASSERT_LE(TwistFromWheels(weak.drive, wheels).forward_m_s,
                TwistFromWheels(weak.drive, straight).forward_m_s + 1e-6)
          << error_rad << " " << tick;
    }
    EXPECT_GT(TwistFromWheels(weak.drive, wheels).turn_rad_s * error_rad, 0) << "then it turns";
  }
}

// To come out of a turn, the slower rim keeps its speed until the other is no faster.
TEST(Steering, OutOfATurnItBrakesWithoutTurningOn) {
  RobotModel weak = PioneerP3dx();
  weak.acceleration_m_s2 = 2;
  weak.deceleration_m_s2 = 0.2;
  WheelSpeeds wheels = WheelsFromTwist(weak.drive, {0.7, 0.3});
  for (int tick = 0; tick < 8; ++tick) {
    const Twist now = TwistFromWheels(weak.drive, wheels);
    const WheelSpeeds target = Drive(weak, now, {.heading_error_rad = -0.25}, {0.6, true, 0.05});
    wheels = {BrakedOrFaster(weak, wheels.left_rad_s, target.left_rad_s),
              BrakedOrFaster(weak, wheels.right_rad_s, target.right_rad_s)};
    EXPECT_LT(TwistFromWheels(weak.drive, wheels).forward_m_s, now.forward_m_s);
    EXPECT_LT(TwistFromWheels(weak.drive, wheels).turn_rad_s, now.turn_rad_s);
  }
}

// By how much it turns, and how far it comes, until it stands.
struct Stop {
  double turned_rad = 0;
  double way_m = 0;
};

Stop StopOutOfATurn(const RobotModel& profile, bool straightens) {
  Stop stop;
  WheelSpeeds wheels = WheelsFromTwist(profile.drive, {0.8, 0.26});
  for (int tick = 0; tick < 200; ++tick) {
    const Twist now = TwistFromWheels(profile.drive, wheels);
    stop.turned_rad += 0.05 * now.turn_rad_s;
    stop.way_m += 0.05 * now.forward_m_s;
    const Pace pace = {
        .limit_m_s = 0, .may_turn = true, .tick_s = 0.05, .straightens = straightens};
    const WheelSpeeds target = Drive(profile, now, {.heading_error_rad = 0}, pace);
    wheels = {BrakedOrFaster(profile, wheels.left_rad_s, target.left_rad_s),
              BrakedOrFaster(profile, wheels.right_rad_s, target.right_rad_s)};
  }
  EXPECT_EQ(wheels, WheelSpeeds{});
  return stop;
}

// From one_lane 28, a robot with strong motors and weak brakes: it braked in a passage while it
// turned, turned until it stood, and touched the wall next to it.
TEST(Steering, ForWhatStandsAheadItComesOutOfItsTurnBeforeItStands) {
  RobotModel weak = PioneerP3dx();
  weak.acceleration_m_s2 = 2;
  weak.deceleration_m_s2 = 0.2;
  const Stop alike = StopOutOfATurn(weak, false);
  const Stop straight = StopOutOfATurn(weak, true);
  EXPECT_GT(alike.turned_rad, 0.4);
  EXPECT_LT(straight.turned_rad, 0.07);
  EXPECT_LT(straight.way_m, 1.12 * alike.way_m);
}

// The brain's wheels in a turn to the left, behind an echo straight ahead and, if there is one, a
// peer that comes towards it.
WheelSpeeds TargetInATurn(RobotModel profile, std::optional<double> peer_x_m) {
  VehicleOptions options = test::DefaultOptions();
  options.profile = std::move(profile);
  test::BrainBench bench(options);
  Outputs out;
  for (std::uint32_t tick = 0; tick < 4; ++tick) {
    RangeScan scan = test::ClearScan(0);
    scan.wheels = {3, 3.5};
    for (const int sensor : {3, 4}) test::SetEcho(&scan, sensor, 0.3);
    std::vector<Beacon> heard;
    if (peer_x_m) heard.push_back(test::BeaconOf(2, tick, {{*peer_x_m, 0}, kPi}));
    out = bench.Step(scan, heard);
  }
  EXPECT_EQ(out.command.decision.rule, Rule::kObstacle);
  return out.command.target;
}

TEST(Steering, StraightensOnlyWithWeakBrakesAndWhereNoPeerCountsOnThem) {
  RobotModel weak = PioneerP3dx();
  weak.acceleration_m_s2 = 2;
  weak.deceleration_m_s2 = 0.2;
  EXPECT_NEAR(TargetInATurn(weak, std::nullopt).left_rad_s, 3, 1e-9);
  EXPECT_NEAR(TargetInATurn(weak, 2).left_rad_s, 3, 1e-9);
  EXPECT_LT(TargetInATurn(weak, 0.9).left_rad_s, 2);
  EXPECT_LT(TargetInATurn(PioneerP3dx(), std::nullopt).left_rad_s, 2);
}

// From one_lane 1446 of mixed fleets: the turn asked for was sharper than the drive makes, which
// slowed the faster rim instead of the other, tick by tick, and it turned until it stood.
TEST(Steering, NoTurnIsLeftBySharperOneThanTheDriveMakes) {
  RobotModel slow = PioneerP3dx();
  slow.acceleration_m_s2 = 0.53;
  slow.deceleration_m_s2 = 0.22;
  slow.max_turn_rad_s = 0.82;
  const WheelSpeeds now = WheelsFromTwist(slow.drive, {0.72, -0.095});
  const Pace pace = {.limit_m_s = 0.2, .may_turn = true, .tick_s = 0.05, .straightens = true};
  const Twist asked =
      TwistFromWheels(slow.drive, Drive(slow, TwistFromWheels(slow.drive, now), {}, pace));
  EXPECT_LE(asked.turn_rad_s, slow.max_turn_rad_s + 1e-9);
  EXPECT_GT(asked.turn_rad_s, 0);
}

// From door 1411 of mixed fleets, a robot whose encoders are 1.7 % off each tick, and whose brakes
// take less than that off its speed: it took one rim and then the other for the slower one, which
// kept its speed, braked by half as much as it can, and drove into the end of a wall.
TEST(Steering, ATurnThatNoiseMayBeKeepsNoRimFromBraking) {
  RobotModel weak = PioneerP3dx();
  weak.acceleration_m_s2 = 2;
  weak.deceleration_m_s2 = 0.2;
  weak.encoder_noise = 0.02;  // it turns five times as fast as that shows
  EXPECT_NEAR(TargetInATurn(weak, std::nullopt).left_rad_s, 3, 1e-9);
  weak.encoder_noise = 0.1;
  EXPECT_LT(TargetInATurn(weak, std::nullopt).left_rad_s, 2);
}

// A wall near the left shoulder, at the range its cone reports; the goal is straight ahead. The
// echo stays the same while the vehicle turns: it is set once.
TEST(Steering, WhatStopsAnAimlessVehicleIsTurnedAwayFrom) {
  test::BrainBench bench(test::DefaultOptions());
  RangeScan scan = test::ClearScan(0);
  test::SetEcho(&scan, 1, 0.12);
  Outputs out;
  for (int tick = 0; tick < 100; ++tick) {  // 5 s: it waits for what may go away again
    out = bench.Step(scan);
    ASSERT_EQ(out.command.decision.rule, Rule::kObstacle);
    EXPECT_EQ(out.command.target, WheelSpeeds{});
  }
  for (int tick = 0; tick < 40; ++tick) out = bench.Step(scan);
  EXPECT_LT(TwistFromWheels(PioneerP3dx().drive, out.command.target).turn_rad_s, 0);
}

// At 0.6 m/s with weak brakes, to a goal at that bearing, with one echo.
struct Echoed {
  int sensor;
  double range_m;
  double noise;
};
Outputs DrivesBeside(const Echoed& echo, double goal_rad) {
  VehicleOptions options = test::DefaultOptions();
  options.profile.deceleration_m_s2 = 0.22;
  options.cruise_m_s = 0.6;
  options.sonar_noise = echo.noise;
  options.goal.at_world = {10 * Cos(goal_rad), 10 * Sin(goal_rad)};
  test::BrainBench bench(options);
  RangeScan scan = test::ClearScan(0);
  test::SetEcho(&scan, echo.sensor, echo.range_m);
  scan.wheels = test::Rolling(0.6);
  return bench.Step(scan);
}

double SpeedOf(const Outputs& out) {
  return TwistFromWheels(PioneerP3dx().drive, out.command.target).forward_m_s;
}

// It slows down before it turns to that bearing, and neither straight on nor to the other side.
void ExpectSlowsTowards(const Echoed& echo, double goal_rad) {
  const Outputs towards = DrivesBeside(echo, goal_rad);
  EXPECT_EQ(towards.command.decision.rule, Rule::kObstacle);
  EXPECT_LT(SpeedOf(towards), 0.56);
  for (const double other_rad : {0.0, -goal_rad}) {
    EXPECT_EQ(DrivesBeside(echo, other_rad).command.decision.rule, Rule::kCruise) << other_rad;
  }
}

// From one_lane 150: a face to the side continues ahead of where a sensor hears it. A vehicle
// turned towards a wall at full speed, and kept turning while it braked.
TEST(Steering, TowardsAWallBesideItItSlowsDownBeforeItTurns) {
  ExpectSlowsTowards({.sensor = 0, .range_m = 0.3, .noise = 0.01}, 0.28);
  const Echoed exact{.sensor = 0, .range_m = 0.3, .noise = 0};
  EXPECT_EQ(DrivesBeside(exact, 0.28).command.decision.rule, Rule::kCruise);
}

// From door 279 and corridor 414: exact ultrasonics heard the wall, which was not straight ahead.
TEST(Steering, TowardsWhatItHearsItSlowsDownBeforeItTurns) {
  ExpectSlowsTowards({.sensor = 1, .range_m = 0.6, .noise = 0}, 0.6);
}

// What it decides after it has driven at 0.6 m/s and turned at that rate for a second, to a goal on
// its left, while a face to its right came nearer by 0.18 m/s and is at that range now.
Decision BesideASlantingFace(double turn_rad_s, double range_m) {
  VehicleOptions options = test::DefaultOptions();
  options.profile.deceleration_m_s2 = 0.22;
  options.cruise_m_s = 0.6;
  options.sonar_noise = 0.01;
  options.goal.at_world = {10, 6};
  test::BrainBench bench(options);
  Outputs out;
  for (int tick = 20; tick >= 0; --tick) {
    RangeScan scan = test::ClearScan(0);
    test::SetEcho(&scan, 7, range_m + 0.009 * tick);
    scan.wheels = WheelsFromTwist(options.profile.drive, {0.6, turn_rad_s});
    out = bench.Step(scan);
  }
  return out.command.decision;
}

// From one_lane 504 and 582: in a turn no slant counted, and a turn away counted as if it never
// ended.
TEST(Steering, AFaceThatSlantsCountsInATurnToo) {
  EXPECT_EQ(BesideASlantingFace(0, 0.25).rule, Rule::kObstacle);
  EXPECT_EQ(BesideASlantingFace(0.3, 0.25).rule, Rule::kObstacle);
  EXPECT_EQ(BesideASlantingFace(0.3, 1.5).rule, Rule::kCruise);
}

// The range a sensor reports of a wall along y = wall_y_m, south of it: the nearest point within
// its cone.
double RangeToWall(const RobotModel& profile, std::size_t sensor, const Pose& world_from_body,
                   double wall_y_m) {
  const SensorMount& mount = profile.sonar[sensor];
  const double off_rad = WrapAngle(world_from_body.heading_rad + mount.bearing_rad + kPi / 2);
  const double half_rad = profile.sonar_half_angle_rad;
  const double slant_rad = off_rad - std::clamp(off_rad, -half_rad, half_rad);
  const double above_m = ToWorld(world_from_body, mount.position_body).y - wall_y_m;
  return Magnitude(slant_rad) < 1.5 ? above_m / Cos(slant_rad) : 1e9;
}

// From corridor 474. A peer that touches this vehicle blocks its path; the vehicle has no sensors
// on that side. On the other side it has echoes of the wall in so many directions that no heading
// past the peer is free.
TEST(Steering, PastAVehicleItTurnsAlsoWhereEchoesLeaveNoHeading) {
  VehicleOptions options = test::OptionsWithoutUltrasonics();
  for (std::size_t i = 3; i < 8; ++i) options.profile.sonar[i].enabled = true;
  options.start_world.heading_rad = -kPi / 4;
  test::BrainBench bench(options);
  Outputs out;
  for (std::uint32_t tick = 0; tick < 1200; ++tick) {
    RangeScan scan = test::ClearScan(0);
    scan.wheels = out.command.target;
    for (std::size_t i = 3; i < 8; ++i) {
      const double range_m = RangeToWall(options.profile, i, out.beacon.world_from_body, -0.54);
      if (range_m < 3) test::SetEcho(&scan, static_cast<int>(i), range_m);
    }
    Beacon beside = test::BeaconOf(2, tick, {{0.427, 0.348}, 3 * kPi / 4});
    beside.toward_world = {-10, 0.6};
    beside.rule = Rule::kKeepClear;  // held up as well
    out = bench.Step(scan, tick == 0 ? std::vector<Beacon>{} : std::vector{beside});
  }
  EXPECT_GT(out.beacon.world_from_body.position_world.x, 0.1);
}

// From swarm 1130: shell to shell between two that stand. The only exit is square to the line
// through all three, and no wider than a twenty-fourth of a radian.
TEST(Steering, ANarrowWayOutBetweenTwoBodiesIsOne) {
  VehicleOptions options = test::OptionsWithoutUltrasonics();
  options.start_world.heading_rad = 2.857;
  options.goal.at_world = {-7.4, 2.17};
  test::BrainBench bench(options);
  Outputs out;
  for (std::uint32_t tick = 0; tick < 400; ++tick) {
    const auto parked = [tick](std::uint32_t id, Vec2 at_world) {
      Beacon beacon = test::BeaconOf(id, tick, {at_world});
      beacon.toward_world = at_world;
      beacon.rule = Rule::kArrived;
      return beacon;
    };
    RangeScan scan = test::ClearScan(0);
    scan.wheels = out.command.target;
    if (tick == 0) scan.run_state = RunState::kWaiting;  // it hears the two before it starts
    out = bench.Step(
        scan, tick == 0 ? std::vector<Beacon>{}
                        : std::vector{parked(2, {-0.5104, -0.2316}), parked(3, {0.5014, 0.2385})});
  }
  EXPECT_GT(Norm(out.beacon.world_from_body.position_world), 1);
}

// From corridor 7354: an oncoming peer stands shell to shell with it, and the path past it leads
// towards a wall. A heading clear of both points so far back that rounding decides whether it is
// one, and with every bit that the vehicle turns the echoes turn too.
TEST(Steering, BesideAWallItDoesNotTurnToAndFroForEver) {
  VehicleOptions options = test::OptionsWithoutUltrasonics();
  for (std::size_t i = 0; i < 8; ++i) options.profile.sonar[i].enabled = true;
  options.start_world.heading_rad = -2.3;
  options.goal.at_world = {-10, -0.26};
  test::BrainBench bench(options);
  Outputs out;
  for (std::uint32_t tick = 0; tick < 420; ++tick) {
    RangeScan scan = test::ClearScan(0);
    if (tick >= 130) scan.wheels = out.command.target;  // until then it is held where it stands
    for (std::size_t i = 0; i < 8; ++i) {
      const double range_m = RangeToWall(options.profile, i, out.beacon.world_from_body, -0.675);
      if (range_m < 3) test::SetEcho(&scan, static_cast<int>(i), range_m);
    }
    Beacon beside = test::BeaconOf(2, tick, {{-0.371, 0.421}, kPi / 4});
    beside.toward_world = {10, 0.421};
    beside.rule = Rule::kObstacle;
    out = bench.Step(scan, tick == 0 ? std::vector<Beacon>{} : std::vector{beside});
  }
  EXPECT_LT(out.beacon.world_from_body.position_world.x, -0.9);
}

// Echoes all round, and a peer that stands at the vehicle's side, not in its path: there is no
// reason to turn along the peer's edge.
TEST(Steering, WhereEchoesAloneCoverTheWayItIsKept) {
  test::BrainBench bench(test::DefaultOptions());
  RangeScan scan = test::ClearScan(0);
  for (int sensor = 0; sensor < 8; ++sensor) test::SetEcho(&scan, sensor, 0.35);
  Outputs out;
  for (std::uint32_t tick = 0; tick < 200; ++tick) {
    Beacon beside = test::BeaconOf(2, tick, {{-0.1, 0.55}, kPi});
    beside.toward_world = beside.world_from_body.position_world;
    beside.rule = Rule::kArrived;
    scan.wheels = {};  // it is held where it stands
    out = bench.Step(scan, tick == 0 ? std::vector<Beacon>{} : std::vector{beside});
  }
  EXPECT_GE(bench.Brain().State().progress.no_progress_ticks, 120U);
  EXPECT_NEAR(TwistFromWheels(PioneerP3dx().drive, out.command.target).turn_rad_s, 0, 0.1);
}

}  // namespace
}  // namespace giveway

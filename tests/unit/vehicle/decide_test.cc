// The ladder and the fold, edge by edge, with one brain on a table.
#include "services/vehicle/decision/decide.h"

#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

// A peer south of the crossing at the origin, heading north at its cruise speed.
Beacon Crossing(std::uint32_t tick, double cruise_m_s, double south_m, double own_north = 0) {
  Beacon beacon = BeaconOf(
      2, tick, {.position_world = {4, -south_m + own_north}, .heading_rad = kPi / 2}, cruise_m_s);
  const double wheel = cruise_m_s / 0.0975;
  beacon.wheels = {wheel, wheel};
  return beacon;
}

RangeScan Driving(double speed_m_s) {
  RangeScan scan = ClearScan(0);
  scan.wheels = {speed_m_s / 0.0975, speed_m_s / 0.0975};
  return scan;
}

TEST(Decide, WithNothingInTheWayItCruises) {
  BrainBench bench(test::DefaultOptions());
  const Outputs out = bench.Step(ClearScan(1));
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
  EXPECT_EQ(out.command.decision.mode, Mode::kCooperative);
  EXPECT_NEAR(out.command.target.left_rad_s, 0.3 / 0.0975, 1e-9);
}

TEST(Decide, BeforeTheStartItStands) {
  BrainBench bench(test::DefaultOptions());
  RangeScan scan = ClearScan(1);
  scan.run_state = RunState::kWaiting;
  const Outputs out = bench.Step(scan);
  EXPECT_EQ(out.command.decision.rule, Rule::kNotRunning);
  EXPECT_EQ(out.command.target, WheelSpeeds{});
}

TEST(Decide, CooperativeToHaltWhenRangesGoStale) {
  BrainBench bench(test::DefaultOptions());
  bench.Step(ClearScan(1));
  Outputs out;
  for (int i = 0; i < 3; ++i) out = bench.StepBlind();
  EXPECT_EQ(out.command.decision.mode, Mode::kCooperative);
  out = bench.StepBlind();
  EXPECT_EQ(out.command.decision.mode, Mode::kHalt);
  EXPECT_EQ(out.command.decision.rule, Rule::kRangesStale);
  EXPECT_EQ(out.command.target, WheelSpeeds{});
}

TEST(Decide, HaltToCooperativeWhenRangesReturn) {
  BrainBench bench(test::DefaultOptions());
  for (int i = 0; i < 5; ++i) bench.StepBlind();
  EXPECT_EQ(bench.Step(ClearScan(0)).command.decision.mode, Mode::kCooperative);
}

TEST(Decide, ADeadSensorHaltsAndIsNamed) {
  BrainBench bench(test::DefaultOptions());
  RangeScan scan = ClearScan(1);
  scan.readings[2].kind = Echo::kNoData;
  const Outputs out = bench.Step(scan);
  EXPECT_EQ(out.command.decision.rule, Rule::kRangesStale);
  EXPECT_EQ(out.command.decision.sensor, 2);
}

TEST(Decide, CooperativeToSensorOnlyWhenAPeerFallsSilent) {
  BrainBench bench(test::DefaultOptions());
  RangeScan wall = ClearScan(0);  // something that shows that the ultrasonics work
  test::SetEcho(&wall, 7, 4);
  bench.Step(wall);
  Outputs out = bench.Step(wall, {BeaconOf(2, 1, {.position_world = {0, 3}})});
  EXPECT_EQ(out.command.decision.mode, Mode::kCooperative);
  for (int i = 0; i < 4; ++i) out = bench.Step(wall);
  EXPECT_EQ(out.command.decision.mode, Mode::kCooperative);
  out = bench.Step(wall);
  EXPECT_EQ(out.command.decision.mode, Mode::kSensorOnly);
}

TEST(Decide, SensorOnlyToCooperativeWhenThePeerIsBack) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  bench.Step(ClearScan(1));
  bench.Step(ClearScan(2), {BeaconOf(2, 1, {.position_world = {0, 3}})});
  for (int i = 0; i < 6; ++i) bench.Step(ClearScan(0));
  const std::uint32_t tick = bench.NextTick();
  const Outputs out = bench.Step(ClearScan(0), {BeaconOf(2, tick - 1, {.position_world = {0, 3}})});
  EXPECT_EQ(out.command.decision.mode, Mode::kCooperative);
}

TEST(Decide, SensorOnlyToHaltWhenRangesGoStaleToo) {
  BrainBench bench(test::DefaultOptions());
  bench.Step(ClearScan(1));
  bench.Step(ClearScan(2), {BeaconOf(2, 1, {.position_world = {0, 3}})});
  for (int i = 0; i < 6; ++i) bench.Step(ClearScan(0));
  Outputs out;
  for (int i = 0; i < 4; ++i) out = bench.StepBlind();
  EXPECT_EQ(out.command.decision.mode, Mode::kHalt);
}

TEST(Decide, AMovingEchoWithoutABeaconIsSensorOnlyAndStops) {
  BrainBench bench(test::DefaultOptions());
  Outputs out;
  for (int i = 0; i < 12; ++i) {
    RangeScan scan = ClearScan(0);
    test::SetEcho(&scan, 1, 1.1 - 0.03 * i);  // closes at 0.6 m/s while this vehicle stands
    out = bench.Step(scan);
  }
  EXPECT_EQ(out.command.decision.rule, Rule::kUnidentifiedMotion);
  EXPECT_EQ(out.command.decision.mode, Mode::kSensorOnly);
  EXPECT_EQ(out.command.decision.sensor, 1);
  EXPECT_EQ(out.command.target, WheelSpeeds{});
}

TEST(Decide, AStandingEchoBesideThePathIsNoObstacle) {
  BrainBench bench(test::DefaultOptions());
  Outputs out;
  for (int i = 0; i < 12; ++i) {
    RangeScan scan = ClearScan(0);
    test::SetEcho(&scan, 0, 0.4);  // a wall at its side
    out = bench.Step(scan);
  }
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
}

TEST(Decide, AnEchoInThePathLimitsTheSpeedToWhatStopsBeforeIt) {
  for (const Behaviour behaviour : {Behaviour::kCooperative, Behaviour::kLectureYield}) {
    VehicleOptions options = test::DefaultOptions();
    options.behaviour = behaviour;
    BrainBench bench(options);
    RangeScan scan = ClearScan(0);
    test::SetEcho(&scan, 3, 0.3);
    const Outputs out = bench.Step(scan);
    EXPECT_EQ(out.command.decision.rule, Rule::kObstacle);
    EXPECT_EQ(out.command.decision.sensor, 3);
    EXPECT_LT(out.command.target.left_rad_s, 0.3 / 0.0975);
  }
}

// Its beacon said that it cruises: it would stand without any limit too. Of equal limits the more
// specific reason is named.
TEST(Decide, AVehicleExactlyOnItsGoalSaysWhyItStands) {
  VehicleOptions options = test::DefaultOptions();
  options.goal.at_world = {0, 0};
  BrainBench bench(options);
  EXPECT_EQ(bench.Step(ClearScan(1)).command.decision.rule, Rule::kArrived);
  Outputs out;
  for (int i = 0; i < 4; ++i) out = bench.StepBlind();
  EXPECT_EQ(out.command.decision.rule, Rule::kRangesStale);
  RangeScan scan = ClearScan(1);
  scan.run_state = RunState::kWaiting;
  EXPECT_EQ(bench.Step(scan).command.decision.rule, Rule::kNotRunning);
}

// Own vehicle at the origin heading east at 0.3 m/s; the crossing is at (4, 0).
TEST(Decide, TheSlowerSaysItGivesWayLongBeforeItHasToStop) {
  BrainBench bench(test::DefaultOptions());
  bench.Step(Driving(0.3));
  const Outputs out = bench.Step(Driving(0.3), {Crossing(1, 0.4, 3)});
  EXPECT_EQ(out.beacon.gives_way_to, VehicleId{2});
  EXPECT_EQ(out.command.decision.rule, Rule::kCruise);
}

TEST(Decide, TheFasterGivesWayToNobody) {
  BrainBench bench(test::DefaultOptions());
  bench.Step(Driving(0.3));
  const Outputs out = bench.Step(Driving(0.3), {Crossing(1, 0.2, 2)});
  EXPECT_EQ(out.beacon.gives_way_to, kNoVehicle);
}

constexpr WheelSpeeds kCreeping = {0.3, 0.3};  // 3 cm/s

// Drives towards the crossing with the peer 1.2 m south of it, standing by default; returns the
// last outputs.
Outputs DriveUpTo(BrainBench* bench, double peer_cruise_m_s, VehicleId peer_gives_way_to,
                  WheelSpeeds peer_wheels = {}) {
  Outputs out;
  for (int i = 0; i < 400; ++i) {
    Beacon beacon = Crossing(bench->NextTick() - 1, peer_cruise_m_s, 1.2);
    beacon.wheels = peer_wheels;
    beacon.gives_way_to = peer_gives_way_to;
    const bool first = bench->NextTick() == 1;
    out = bench->Step(Driving(0.3), first ? std::vector<Beacon>{} : std::vector{beacon});
    if (out.command.target == WheelSpeeds{}) break;
  }
  return out;
}

TEST(Decide, TheSlowerStopsBeforeTheConflict) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUpTo(&bench, 0.4, kNoVehicle);
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
  EXPECT_EQ(out.command.decision.peer, VehicleId{2});
  EXPECT_LT(out.beacon.world_from_body.position_world.x, 3.3 - 0.075);
}

TEST(Decide, TheFirstInOrderStopsToo) {
  SCOPED_TRACE("where the peer has not said that it gives way");
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUpTo(&bench, 0.2, kNoVehicle, kCreeping);
  EXPECT_EQ(out.command.decision.rule, Rule::kNotGranted);
  EXPECT_LT(out.beacon.world_from_body.position_world.x, 3.4 - 0.075);
}

TEST(Decide, TheFirstInOrderDrivesOnOnceThePeerHasSaidSo) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUpTo(&bench, 0.2, VehicleId{1});
  EXPECT_NE(out.command.decision.rule, Rule::kNotGranted);
  EXPECT_GT(out.beacon.world_from_body.position_world.x, 4.7);
}

TEST(Decide, AGrantToSomebodyElseIsNone) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  EXPECT_EQ(DriveUpTo(&bench, 0.2, VehicleId{3}, kCreeping).command.decision.rule,
            Rule::kNotGranted);
}

TEST(Decide, WhoeverStandsAndComesLaterIsABodyAndNotAPath) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUpTo(&bench, 0.2, kNoVehicle);
  EXPECT_GT(out.beacon.world_from_body.position_world.x, 4.7);
}

TEST(Decide, AStopOnceBegunIsNotTakenBackAsTheVehicleSlows) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  DriveUpTo(&bench, 0.4, kNoVehicle);
  for (double speed = 0.27; speed >= 0; speed -= 0.03) {
    Beacon beacon = Crossing(bench.NextTick() - 1, 0.4, 1.2);
    beacon.wheels = {};
    const Outputs out = bench.Step(Driving(speed), {beacon});
    ASSERT_EQ(out.command.target, WheelSpeeds{}) << speed;
  }
}

// The path no longer conflicts, but the peer backs towards the one that waits for it.
TEST(Decide, AnEncounterIsNotOverWhileThePeerStillComesNearer) {
  BrainBench bench(test::DefaultOptions());
  DriveUpTo(&bench, 0.4, kNoVehicle);
  Beacon beacon = Crossing(bench.NextTick() - 1, 0.4, 0.8);
  beacon.world_from_body.heading_rad = -kPi / 2;
  beacon.wheels = {-2, -2};
  EXPECT_EQ(bench.Step(Driving(0), {beacon}).command.decision.rule, Rule::kGiveWay);
  beacon = Crossing(bench.NextTick() - 1, 0.4, 0.8);
  beacon.world_from_body.heading_rad = -kPi / 2;
  beacon.toward_world = beacon.world_from_body.position_world - Vec2{0, 10};
  beacon.wheels = {2, 2};
  EXPECT_EQ(bench.Step(Driving(0), {beacon}).command.decision.rule, Rule::kCruise);
}

// 2.1 m off the path: enough to pass a small body, not a large one.
TEST(Decide, APeersOwnSizeDecidesHowMuchRoomItNeeds) {
  for (const double radius_m : {0.25, 1.7}) {
    BrainBench bench(test::DefaultOptions());
    bench.Step(Driving(0));
    Beacon beacon = BeaconOf(2, 1, {.position_world = {4.5, 2.0}, .heading_rad = kPi}, 0.4);
    beacon.body_radius_m = radius_m;
    const VehicleId expected = radius_m > 1 ? VehicleId{2} : kNoVehicle;
    EXPECT_EQ(bench.Step(Driving(0), {beacon}).beacon.gives_way_to, expected) << radius_m;
  }
}

TEST(Decide, AConflictBeyondTheGoalIsNone) {
  VehicleOptions options = test::DefaultOptions();
  options.goal.at_world = {2, 0};
  BrainBench bench(options);
  bench.Step(Driving(0.3));
  EXPECT_EQ(bench.Step(Driving(0.3), {Crossing(1, 0.4, 3)}).beacon.gives_way_to, kNoVehicle);
}

// Sensor 2 hears a wall at 0.8 m; the faster peer is 3 m away in the same direction.
TEST(Decide, AWallInFrontOfAPeerIsNotThePeer) {
  VehicleOptions options = test::DefaultOptions();
  options.behaviour = Behaviour::kLectureYield;
  BrainBench bench(options);
  RangeScan scan = ClearScan(0);
  test::SetEcho(&scan, 1, 0.8);
  bench.Step(scan);
  const Vec2 there = 3.0 * Vec2{Cos(Radians(50)), Sin(Radians(50))};
  const Pose pose{.position_world = there, .heading_rad = Radians(-90)};
  EXPECT_EQ(bench.Step(scan, {BeaconOf(2, 1, pose, 0.4)}).command.decision.rule, Rule::kCruise);
  const Pose near{
      .position_world = {0.114 + 1.05 * Cos(Radians(50)), 0.119 + 1.05 * Sin(Radians(50))},
      .heading_rad = Radians(-90)};
  EXPECT_EQ(bench.Step(scan, {BeaconOf(2, 2, near, 0.4)}).command.decision.rule, Rule::kGiveWay);
}

// By its cone alone the echo could lie in the path; the beacon says that the body is off it.
TEST(Decide, AKnownPeerBesideThePathIsNoObstacle) {
  BrainBench bench(test::DefaultOptions());
  RangeScan scan = ClearScan(0);
  test::SetEcho(&scan, 1, 0.284);
  EXPECT_EQ(bench.Step(scan).command.decision.rule, Rule::kObstacle);
  const Beacon beside = BeaconOf(2, 1, {.position_world = {0.3, 0.62}});  // same heading
  EXPECT_EQ(bench.Step(scan, {beside}).command.decision.rule, Rule::kCruise);
}

// The end of a wall at the left shoulder; the body of the peer is further away and more to the
// side.
TEST(Decide, AWallBeforeAKnownPeerIsAnObstacle) {
  BrainBench bench(test::DefaultOptions());
  RangeScan scan = ClearScan(0);
  test::SetEcho(&scan, 1, 0.117);
  const Beacon beside = BeaconOf(2, 1, {.position_world = {0.3, 0.62}});
  EXPECT_EQ(bench.Step(scan, {beside}).command.decision.rule, Rule::kObstacle);
}

TEST(Decide, LeavingStopsAndSaysSo) {
  Vehicle vehicle(test::DefaultOptions(), 42);
  Inputs inputs;
  inputs.now = std::chrono::milliseconds(50);
  inputs.scan = ClearScan(1);
  inputs.leaving = true;
  const Outputs out = vehicle.Step(inputs);
  EXPECT_EQ(out.command.target, WheelSpeeds{});
  EXPECT_EQ(out.beacon.mode, Mode::kLeaving);
}

}  // namespace
}  // namespace giveway

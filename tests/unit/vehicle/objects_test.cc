// When an object that radar or lidar shows is an obstacle, and when it stays an object.
#include "services/vehicle/estimation/objects.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;

constexpr double kSpeed_m_s = 0.3;

RangeScan Driving(double speed_m_s = kSpeed_m_s) {
  RangeScan scan = ClearScan(0);
  scan.wheels = {speed_m_s / 0.0975, speed_m_s / 0.0975};
  return scan;
}

// What a radar that moves at `own` reports of a point at (x, y) from it that moves at `velocity`.
RadarScan RadarOf(Vec2 at, Vec2 velocity, double own_m_s = kSpeed_m_s) {
  RadarScan scan;
  scan.count = 1;
  const double range = Norm(at);
  scan.detections[0] = {.range_m = range,
                        .bearing_rad = Atan2(at.y, at.x),
                        .range_rate_m_s = Dot(velocity - Vec2{own_m_s, 0}, at) / range};
  return scan;
}

LidarScan LidarOf(int beam_deg, double range_m) {
  LidarScan scan;
  scan.echo.fill(Echo::kClear);
  scan.echo[static_cast<std::size_t>(beam_deg + 90)] = Echo::kEcho;
  scan.range_m[static_cast<std::size_t>(beam_deg + 90)] = range_m;
  return scan;
}

CameraScan CameraOf(SeenClass seen_class, double bearing_rad) {
  CameraScan scan;
  scan.count = 1;
  scan.objects[0] = {.seen_class = seen_class, .bearing_rad = bearing_rad, .half_width_rad = 0.2};
  return scan;
}

class Objects : public testing::Test {
 protected:
  Outputs Step(double speed_m_s = kSpeed_m_s, const std::vector<Beacon>& beacons = {}) {
    return bench_.Step(Driving(speed_m_s), beacons);
  }
  Rule RuleWith(const RadarScan& radar, double speed_m_s = kSpeed_m_s) {
    bench_.WithNext().radar = radar;
    return Step(speed_m_s).command.decision.rule;
  }

  BrainBench bench_{test::DefaultOptions()};
};

double TargetSpeed(const Outputs& out) {
  return TwistFromWheels(DriveGeometry{}, out.command.target).forward_m_s;
}

TEST_F(Objects, WhatStandsInTheCorridorLimitsTheSpeedToStopBeforeIt) {
  bench_.WithNext().lidar = LidarOf(0, 0.5);
  const Outputs out = Step();
  EXPECT_EQ(out.command.decision.rule, Rule::kObject);
  EXPECT_EQ(out.command.decision.cause_tick, Tick{1});
  // The margin widens the body by 0.05 m: 0.2 m are free, 0.15 m of them are kept.
  EXPECT_NEAR(TargetSpeed(out), SpeedToStopWithin(0.05, 0.1, 0.6), 1e-9);
}

TEST_F(Objects, FarAheadOrBesideTheCorridorItStaysAnObject) {
  bench_.WithNext().lidar = LidarOf(0, 3);
  EXPECT_EQ(Step().command.decision.rule, Rule::kCruise);
  bench_.WithNext().lidar = LidarOf(45, 0.5);  // 0.35 m to the left
  EXPECT_EQ(Step().command.decision.rule, Rule::kCruise);
  bench_.WithNext().lidar = LidarOf(40, 0.42);  // 0.27 m to the left
  EXPECT_EQ(Step().command.decision.rule, Rule::kObject);
  bench_.WithNext().lidar = LidarOf(89, 0.26);  // a wall it drives along
  EXPECT_EQ(Step().command.decision.rule, Rule::kCruise);
}

TEST_F(Objects, WhatIsPassedByStandingIsNoObstacleHoweverFastItComesNearer) {
  EXPECT_EQ(RuleWith(RadarOf({0.6, 0.4}, {0, 0})), Rule::kCruise);
  EXPECT_EQ(RuleWith(RadarOf({0.5, 0.05}, {0, 0})), Rule::kObject);
}

// From 0.3 m/s it takes 0.1 s to react and 0.5 s to stand.
TEST_F(Objects, WhatComesIntoTheCorridorBeforeTheVehicleCouldStandIsAnObstacle) {
  const Vec2 at = {0.8, 0.8};
  const auto towards = [&](double speed_m_s) { return -speed_m_s / Norm(at) * at; };
  // It is in the corridor, 0.3 m off the path, after it has moved 0.71 m.
  EXPECT_EQ(RuleWith(RadarOf(at, towards(1.3))), Rule::kObject);
  EXPECT_EQ(RuleWith(RadarOf(at, towards(1.1))), Rule::kCruise);
  EXPECT_EQ(RuleWith(RadarOf(at, {0, 0})), Rule::kCruise);
  EXPECT_EQ(RuleWith(RadarOf(at, -1 * towards(2))), Rule::kCruise);
}

TEST_F(Objects, AVehicleThatStandsWaitsForLess) {
  const Vec2 at = {0.8, 0.8};
  EXPECT_EQ(RuleWith(RadarOf(at, -1.3 / Norm(at) * at, 0), 0), Rule::kCruise);
}

TEST_F(Objects, WhatComesHeadOnIsAnObstacleFromFartherAway) {
  const Vec2 at = {1.0, 0};
  EXPECT_EQ(RuleWith(RadarOf(at, {0, 0})), Rule::kCruise);
  EXPECT_EQ(RuleWith(RadarOf(at, {-1, 0})), Rule::kObject);
  EXPECT_EQ(RuleWith(RadarOf(at, {1, 0})), Rule::kCruise);
}

// A vehicle stands across the path just ahead and says so.
class KnownPeer : public Objects {
 protected:
  Rule RuleWith(std::optional<SeenClass> seen_class, bool beacons = true) {
    for (int i = 0; i < 6; ++i) Step(0);
    Beacon peer = BeaconOf(2, bench_.NextTick() - 1, {.position_world = {0.75, 0}}, 0.6);
    bench_.WithNext().radar = RadarOf({0.5, 0}, {0, 0}, 0);
    if (seen_class) bench_.WithNext().camera = CameraOf(*seen_class, 0.1);
    peer.rule = Rule::kArrived;  // no matter of right of way
    peer.order.speed_bucket = 12;
    std::vector<Beacon> heard;
    if (beacons) heard = {peer};
    return Step(0, heard).command.decision.rule;
  }
};

TEST_F(KnownPeer, IsLeftToRightOfWayWhereTheCameraSeesAVehicle) {
  EXPECT_NE(RuleWith(SeenClass::kVehicle), Rule::kObject);
}
TEST_F(KnownPeer, IsAnObstacleWhereTheCameraSeesSomethingElse) {
  EXPECT_EQ(RuleWith(SeenClass::kCart), Rule::kObject);
}
TEST_F(KnownPeer, IsAnObstacleWithoutACamera) { EXPECT_EQ(RuleWith({}), Rule::kObject); }
TEST_F(KnownPeer, IsAnObstacleWithoutABeacon) {
  EXPECT_EQ(RuleWith(SeenClass::kVehicle, false), Rule::kObject);
}

TEST_F(Objects, WhatWasSeenTooLongAgoStopsNobody) {
  bench_.WithNext().lidar = LidarOf(0, 0.3);
  EXPECT_EQ(Step(0).command.decision.rule, Rule::kObject);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Step(0).command.decision.rule, Rule::kObject) << i;
  EXPECT_EQ(Step(0).command.decision.rule, Rule::kCruise);
}

// What was seen a tick ago is nearer by what has been driven since.
TEST_F(Objects, AnOldScanIsCarriedOnByTheOwnMotion) {
  bench_.WithNext().lidar = LidarOf(0, 0.5);
  Step();
  const Outputs out = Step();
  EXPECT_NEAR(TargetSpeed(out), SpeedToStopWithin(0.05 - 0.015, 0.1, 0.6), 1e-9);
}

TEST_F(Objects, NonsenseIsRefusedAndCounted) {
  Step(0);
  RadarScan radar = RadarOf({0.3, 0}, {0, 0});
  radar.detections[0].range_rate_m_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(RuleWith(radar, 0), Rule::kCruise);
  radar = RadarOf({0.3, 0}, {0, 0});
  radar.count = kMaxDetections + 1;
  EXPECT_EQ(RuleWith(radar, 0), Rule::kCruise);
  bench_.WithNext().lidar = LidarOf(0, -0.1);
  EXPECT_EQ(Step(0).command.decision.rule, Rule::kCruise);
  CameraScan camera = CameraOf(SeenClass::kCart, 9);
  bench_.WithNext().camera = camera;
  Step(0);
  EXPECT_EQ(bench_.Brain().State().counters.scans_refused, 4U);
}

}  // namespace
}  // namespace giveway

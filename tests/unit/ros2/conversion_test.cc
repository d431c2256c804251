// Samples as ROS 2 messages: frames, signs, units, and ROS's values for "no echo".
#include "services/ros2/conversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/types/math/math.h"

namespace giveway::ros2 {
namespace {

constexpr std::uint64_t kStamp_ns = 1'700'000'000'250'000'000;
constexpr double kTiny = 1e-12;

Beacon BeaconOf(VehicleId vehicle) {
  Beacon beacon;
  beacon.vehicle = vehicle;
  beacon.world_from_body = {{1.5, -2}, kPi / 2};
  beacon.covariance = {
      .xx_m2 = 1, .xy_m2 = 2, .yy_m2 = 3, .xh_m_rad = 4, .yh_m_rad = 5, .hh_rad2 = 6};
  beacon.drive = {.wheel_radius_m = 0.1, .axle_m = 0.4};
  beacon.wheels = {2, 4};
  beacon.body_radius_m = 0.25;
  beacon.mode = Mode::kHalt;
  return beacon;
}

TEST(Conversion, StampsAreSecondsAndNanosecondsSince1970) {
  EXPECT_EQ(TimeOf(kStamp_ns).sec, 1'700'000'000);
  EXPECT_EQ(TimeOf(kStamp_ns).nanosec, 250'000'000U);
}

TEST(Conversion, HeadingsAreTurnsAboutZ) {
  const Quaternion left = QuaternionOf(kPi / 2);
  EXPECT_NEAR(left.z, std::sqrt(0.5), kTiny);
  EXPECT_NEAR(left.w, std::sqrt(0.5), kTiny);
  EXPECT_EQ(left.x, 0);
  EXPECT_EQ(left.y, 0);
  EXPECT_NEAR(QuaternionOf(-kPi / 2).z, -std::sqrt(0.5), kTiny);
  EXPECT_NEAR(QuaternionOf(kPi).z, 1, kTiny);
  EXPECT_EQ(QuaternionOf(0).w, 1);
}

TEST(Conversion, OdometryIsThePoseInTheMapAndTheTwistOfTheBody) {
  const Odometry odometry = OdometryOf(BeaconOf(VehicleId{3}), kStamp_ns);
  EXPECT_EQ(odometry.header.frame_id, "map");
  EXPECT_EQ(odometry.child_frame_id, "giveway_v3/base_link");
  EXPECT_EQ(odometry.header.stamp.nanosec, 250'000'000U);
  EXPECT_EQ(odometry.pose.position.x, 1.5);
  EXPECT_EQ(odometry.pose.position.y, -2);
  EXPECT_EQ(odometry.pose.position.z, 0);
  EXPECT_NEAR(odometry.pose.orientation.z, std::sqrt(0.5), kTiny);
  EXPECT_NEAR(odometry.twist.linear.x, 0.3, kTiny);   // r/2 (left + right)
  EXPECT_NEAR(odometry.twist.angular.z, 0.5, kTiny);  // r/axle (right - left)
  EXPECT_EQ(odometry.twist.linear.y, 0);
}

TEST(Conversion, CovarianceStandsInTheRowsOfXYAndYaw) {
  const Covariance rows = OdometryOf(BeaconOf(VehicleId{3}), kStamp_ns).pose_covariance;
  Covariance wanted{};
  wanted[0] = 1;               // x x
  wanted[1] = wanted[6] = 2;   // x y
  wanted[7] = 3;               // y y
  wanted[5] = wanted[30] = 4;  // x yaw
  wanted[11] = wanted[31] = 5;
  wanted[35] = 6;
  EXPECT_EQ(rows, wanted);
}

TEST(Conversion, WhatCannotBeShownIsFound) {
  EXPECT_TRUE(CanShow(BeaconOf(VehicleId{3})));
  Beacon beacon = BeaconOf(VehicleId{3});
  beacon.world_from_body.position_world.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(CanShow(beacon));
  beacon = BeaconOf(VehicleId{3});
  beacon.world_from_body.heading_rad = 1e300;
  EXPECT_FALSE(CanShow(beacon));
  beacon = BeaconOf(VehicleId{3});
  beacon.covariance.hh_rad2 = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(CanShow(beacon));
  beacon = BeaconOf(VehicleId{3});
  beacon.drive.axle_m = 0;
  EXPECT_FALSE(CanShow(beacon));
}

TEST(Conversion, ARangeIsInTheFrameOfItsSensorAndInfiniteWhereNothingAnswered) {
  const RobotModel profile = PioneerP3dx();
  const RangeReading echo{.kind = Echo::kEcho, .range_m = 1.25};
  const Range range = RangeOf(VehicleId{3}, profile, 5, echo, kStamp_ns);
  EXPECT_EQ(range.header.frame_id, "giveway_v3/ultrasonic_5");
  EXPECT_EQ(range.radiation_type, Range::kUltrasound);
  EXPECT_FLOAT_EQ(range.field_of_view, static_cast<float>(kPi / 6));
  EXPECT_EQ(range.min_range, 0);
  EXPECT_EQ(range.max_range, 5);
  EXPECT_EQ(range.range, 1.25F);
  const RangeReading clear{.kind = Echo::kClear, .range_m = 0};
  EXPECT_EQ(RangeOf(VehicleId{3}, profile, 5, clear, kStamp_ns).range,
            std::numeric_limits<float>::infinity());
}

TEST(Conversion, ASensorSitsWhereTheProfileSaysAndLooksAlongItsBearing) {
  const Transform transform = SensorTransform(VehicleId{3}, PioneerP3dx(), 0, kStamp_ns);
  EXPECT_EQ(transform.header.frame_id, "giveway_v3/base_link");
  EXPECT_EQ(transform.child_frame_id, "giveway_v3/ultrasonic_0");
  EXPECT_NEAR(transform.translation.x, 0.069, kTiny);
  EXPECT_NEAR(transform.translation.y, 0.136, kTiny);
  EXPECT_NEAR(transform.rotation.z, std::sqrt(0.5), kTiny);  // 90 degrees to the left
}

TEST(Conversion, AMarkerIsABodyOnTheGroundInTheColourOfItsMode) {
  const Marker marker = BodyMarker(BeaconOf(VehicleId{3}), kStamp_ns, false, 3);
  EXPECT_EQ(marker.ns, "giveway");
  EXPECT_EQ(marker.id, 3);
  EXPECT_EQ(marker.type, Marker::kCylinder);
  EXPECT_EQ(marker.action, Marker::kAdd);
  EXPECT_EQ(marker.scale.x, 0.5);
  EXPECT_EQ(marker.pose.position.z, marker.scale.z / 2);
  EXPECT_EQ(marker.lifetime_s, 3);
  EXPECT_GT(marker.color.r, 0.7F);  // halted: red
  EXPECT_LT(marker.color.b, 0.3F);
  EXPECT_EQ(marker.color.a, 1);
  Beacon driving = BeaconOf(VehicleId{3});
  driving.mode = Mode::kCooperative;
  EXPECT_GT(BodyMarker(driving, kStamp_ns, false, 3).color.b, 0.6F);
  EXPECT_LT(BodyMarker(driving, kStamp_ns, true, 3).color.a, 1);
}

}  // namespace
}  // namespace giveway::ros2

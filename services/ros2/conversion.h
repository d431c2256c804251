// Samples of the fleet as ROS 2 messages: values in, values out. Frames: `map` is the fleet's world
// frame, `giveway_v3/base_link` the axle centre of vehicle 3, `giveway_v3/ultrasonic_5` its
// sensor 5. The world is a plane: z, roll and pitch are 0, and so are their variances.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "services/ros2/messages.h"
#include "services/types/beacon.h"
#include "services/types/range_scan.h"
#include "services/types/robot_model.h"

namespace giveway::ros2 {

Time TimeOf(std::uint64_t since_1970_ns);
// Of a turn about z.
Quaternion QuaternionOf(double heading_rad);

// "/giveway/v3/", the namespace of a vehicle's topics.
std::string Namespace(VehicleId vehicle);
// "giveway_v3/base_link"
std::string BodyFrame(VehicleId vehicle);
// "giveway_v3/ultrasonic_5"
std::string SensorFrame(VehicleId vehicle, std::size_t sensor);

// Whether its numbers are finite, and its heading is an angle.
bool CanShow(const Beacon& beacon);

Twist TwistOf(const DriveGeometry& drive, WheelSpeeds wheels);
// The covariance of the twist is 0, which is "not known": a beacon does not carry it.
Odometry OdometryOf(const Beacon& beacon, std::uint64_t stamp_ns);
// base_link in map.
Transform BodyTransform(const Beacon& beacon, std::uint64_t stamp_ns);
// A sensor in base_link, x along the axis of its cone.
Transform SensorTransform(VehicleId vehicle, const RobotModel& profile, std::size_t sensor,
                          std::uint64_t stamp_ns);
// Precondition: the reading has data. +infinity where nothing answered.
Range RangeOf(VehicleId vehicle, const RobotModel& profile, std::size_t sensor,
              const RangeReading& reading, std::uint64_t stamp_ns);

// A cylinder with the vehicle's id, its colour by the mode as on the page; pale where the vehicle
// is silent. It disappears by itself lifetime_s after the last one.
Marker BodyMarker(const Beacon& beacon, std::uint64_t stamp_ns, bool silent,
                  std::int32_t lifetime_s);
Marker RemovedMarker(VehicleId vehicle, std::uint64_t stamp_ns);

}  // namespace giveway::ros2

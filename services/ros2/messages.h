// The ROS 2 messages of the view as plain values, in the fields and units of ROS (REP 103: metres,
// radians, x forward, y left, z up). Only the fields that the view fills; the rest are empty.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace giveway::ros2 {

// Since 1970.
struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

struct Header {
  Time stamp;
  std::string frame_id;
};

struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

struct Quaternion {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;
};

struct Pose {
  Vector3 position;
  Quaternion orientation;
};

// geometry_msgs/Twist, in the frame of the body: linear m/s, angular rad/s.
struct Twist {
  Vector3 linear;
  Vector3 angular;
};

// Row-major over x, y, z, roll, pitch, yaw.
using Covariance = std::array<double, 36>;

// nav_msgs/Odometry: the pose in header.frame_id, the twist in child_frame_id.
struct Odometry {
  Header header;
  std::string child_frame_id;
  Pose pose;
  Covariance pose_covariance{};
  Twist twist;
  Covariance twist_covariance{};
};

// sensor_msgs/Range. By REP 117 +infinity says that nothing within the range answered.
struct Range {
  static constexpr std::uint8_t kUltrasound = 0;

  Header header;
  std::uint8_t radiation_type = kUltrasound;
  float field_of_view = 0;  // rad, the whole cone
  float min_range = 0;      // m
  float max_range = 0;
  float range = 0;
  float variance = 0;  // 0: not known
};

// geometry_msgs/TransformStamped: child_frame_id in header.frame_id.
struct Transform {
  Header header;
  std::string child_frame_id;
  Vector3 translation;
  Quaternion rotation;
};

// tf2_msgs/TFMessage.
struct Transforms {
  std::vector<Transform> transforms;
};

struct Color {
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 1;
};

// visualization_msgs/Marker.
struct Marker {
  static constexpr std::int32_t kCylinder = 3;
  static constexpr std::int32_t kAdd = 0;
  static constexpr std::int32_t kDelete = 2;

  Header header;
  std::string ns;
  std::int32_t id = 0;
  std::int32_t type = kCylinder;
  std::int32_t action = kAdd;
  Pose pose;
  Vector3 scale;
  Color color;
  std::int32_t lifetime_s = 0;  // 0: until it is deleted
};

// visualization_msgs/MarkerArray.
struct Markers {
  std::vector<Marker> markers;
};

using Body = std::variant<Odometry, Range, Transforms, Markers, Twist>;

struct Message {
  std::string topic;           // "/giveway/v3/odom"
  std::uint64_t stamp_ns = 0;  // since 1970, of the newest sample it is made of
  Body body;
};

}  // namespace giveway::ros2

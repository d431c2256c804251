// The types of ros2.idl, of either version of Fast DDS, and our values as such.
#pragma once

#include "services/link/fastdds/fastdds_version.h"
#include "services/ros2/messages.h"

#if __has_include(<fastrtps/config.h>)
#include <idl_ros2/ros2PubSubTypes.h>
#else
#include <idl_ros2/ros2PubSubTypes.hpp>
#endif

namespace giveway::link {

nav_msgs::msg::dds_::Odometry_ ToWire(const ros2::Odometry& odometry);
sensor_msgs::msg::dds_::Range_ ToWire(const ros2::Range& range);
tf2_msgs::msg::dds_::TFMessage_ ToWire(const ros2::Transforms& transforms);
visualization_msgs::msg::dds_::MarkerArray_ ToWire(const ros2::Markers& markers);
geometry_msgs::msg::dds_::Twist_ ToWire(const ros2::Twist& twist);

// The type support of a wire type.
template <typename Wire>
struct Ros2Support;
template <>
struct Ros2Support<nav_msgs::msg::dds_::Odometry_> {
  using Type = nav_msgs::msg::dds_::Odometry_PubSubType;
};
template <>
struct Ros2Support<sensor_msgs::msg::dds_::Range_> {
  using Type = sensor_msgs::msg::dds_::Range_PubSubType;
};
template <>
struct Ros2Support<tf2_msgs::msg::dds_::TFMessage_> {
  using Type = tf2_msgs::msg::dds_::TFMessage_PubSubType;
};
template <>
struct Ros2Support<visualization_msgs::msg::dds_::MarkerArray_> {
  using Type = visualization_msgs::msg::dds_::MarkerArray_PubSubType;
};
template <>
struct Ros2Support<geometry_msgs::msg::dds_::Twist_> {
  using Type = geometry_msgs::msg::dds_::Twist_PubSubType;
};

}  // namespace giveway::link

#include "services/link/ros2/ros2_types.h"

namespace giveway::link {
namespace {

namespace geometry = geometry_msgs::msg::dds_;

std_msgs::msg::dds_::Header_ HeaderOf(const ros2::Header& header) {
  std_msgs::msg::dds_::Header_ wire;
  wire.stamp().sec(header.stamp.sec);
  wire.stamp().nanosec(header.stamp.nanosec);
  wire.frame_id(header.frame_id);
  return wire;
}

template <typename Wire>  // a point or a vector
Wire Triple(const ros2::Vector3& vector) {
  Wire wire;
  wire.x(vector.x);
  wire.y(vector.y);
  wire.z(vector.z);
  return wire;
}

geometry::Quaternion_ QuaternionOf(const ros2::Quaternion& quaternion) {
  geometry::Quaternion_ wire;
  wire.x(quaternion.x);
  wire.y(quaternion.y);
  wire.z(quaternion.z);
  wire.w(quaternion.w);
  return wire;
}

geometry::Pose_ PoseOf(const ros2::Pose& pose) {
  geometry::Pose_ wire;
  wire.position(Triple<geometry::Point_>(pose.position));
  wire.orientation(QuaternionOf(pose.orientation));
  return wire;
}

geometry::TransformStamped_ TransformOf(const ros2::Transform& transform) {
  geometry::TransformStamped_ wire;
  wire.header(HeaderOf(transform.header));
  wire.child_frame_id(transform.child_frame_id);
  wire.transform().translation(Triple<geometry::Vector3_>(transform.translation));
  wire.transform().rotation(QuaternionOf(transform.rotation));
  return wire;
}

visualization_msgs::msg::dds_::Marker_ MarkerOf(const ros2::Marker& marker) {
  visualization_msgs::msg::dds_::Marker_ wire;
  wire.header(HeaderOf(marker.header));
  wire.ns(marker.ns);
  wire.id(marker.id);
  wire.type(marker.type);
  wire.action(marker.action);
  wire.pose(PoseOf(marker.pose));
  wire.scale(Triple<geometry::Vector3_>(marker.scale));
  wire.color().r(marker.color.r);
  wire.color().g(marker.color.g);
  wire.color().b(marker.color.b);
  wire.color().a(marker.color.a);
  wire.lifetime().sec(marker.lifetime_s);
  return wire;
}

}  // namespace

nav_msgs::msg::dds_::Odometry_ ToWire(const ros2::Odometry& odometry) {
  nav_msgs::msg::dds_::Odometry_ wire;
  wire.header(HeaderOf(odometry.header));
  wire.child_frame_id(odometry.child_frame_id);
  wire.pose().pose(PoseOf(odometry.pose));
  wire.pose().covariance(odometry.pose_covariance);
  wire.twist().twist(ToWire(odometry.twist));
  wire.twist().covariance(odometry.twist_covariance);
  return wire;
}

sensor_msgs::msg::dds_::Range_ ToWire(const ros2::Range& range) {
  sensor_msgs::msg::dds_::Range_ wire;
  wire.header(HeaderOf(range.header));
  wire.radiation_type(range.radiation_type);
  wire.field_of_view(range.field_of_view);
  wire.min_range(range.min_range);
  wire.max_range(range.max_range);
  wire.range(range.range);
  wire.variance(range.variance);
  return wire;
}

tf2_msgs::msg::dds_::TFMessage_ ToWire(const ros2::Transforms& transforms) {
  tf2_msgs::msg::dds_::TFMessage_ wire;
  for (const ros2::Transform& one : transforms.transforms) {
    wire.transforms().push_back(TransformOf(one));
  }
  return wire;
}

visualization_msgs::msg::dds_::MarkerArray_ ToWire(const ros2::Markers& markers) {
  visualization_msgs::msg::dds_::MarkerArray_ wire;
  for (const ros2::Marker& one : markers.markers) wire.markers().push_back(MarkerOf(one));
  return wire;
}

geometry::Twist_ ToWire(const ros2::Twist& twist) {
  geometry::Twist_ wire;
  wire.linear(Triple<geometry::Vector3_>(twist.linear));
  wire.angular(Triple<geometry::Vector3_>(twist.angular));
  return wire;
}

}  // namespace giveway::link

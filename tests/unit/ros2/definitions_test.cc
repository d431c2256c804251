// The definitions of message types in a recording. tests/web/ros2.mjs compares the fields with the
// public ones.
#include "services/ros2/definitions.h"

#include <gtest/gtest.h>

namespace giveway::ros2 {
namespace {

TEST(Definitions, EachKindOfMessageHasTheNameOfItsType) {
  EXPECT_EQ(TypeOf(Odometry{}), "nav_msgs/msg/Odometry");
  EXPECT_EQ(TypeOf(Range{}), "sensor_msgs/msg/Range");
  EXPECT_EQ(TypeOf(Transforms{}), "tf2_msgs/msg/TFMessage");
  EXPECT_EQ(TypeOf(Markers{}), "visualization_msgs/msg/MarkerArray");
  EXPECT_EQ(TypeOf(Twist{}), "geometry_msgs/msg/Twist");
}

TEST(Definitions, ATypeComesFirstAndEachOfItsPartsOnce) {
  const std::string line(80, '=');
  EXPECT_EQ(DefinitionOf("geometry_msgs/msg/Twist"),
            "Vector3 linear\nVector3 angular\n" + line +
                "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n");
  const std::string odometry = DefinitionOf("nav_msgs/msg/Odometry");
  std::size_t parts = 0;
  for (std::size_t at = odometry.find("MSG: "); at != std::string::npos;
       at = odometry.find("MSG: ", at + 1)) {
    ++parts;
  }
  // Header, Time, PoseWithCovariance, Pose, Point, Quaternion, TwistWithCovariance, Twist, Vector3.
  EXPECT_EQ(parts, 9U);
  for (const Body& body : {Body(Range{}), Body(Transforms{}), Body(Markers{})}) {
    EXPECT_NE(DefinitionOf(TypeOf(body)).find("MSG: std_msgs/Header\n"), std::string::npos);
  }
}

TEST(Definitions, OnlyTransformsThatDoNotChangeAreKeptForLateJoiners) {
  EXPECT_TRUE(OfferOf("/tf_static").transient_local);
  EXPECT_FALSE(OfferOf("/tf").transient_local);
  EXPECT_FALSE(OfferOf("/giveway/v3/odom").transient_local);
  EXPECT_EQ(OfferOf("/giveway/v3/odom").depth, 10);
  EXPECT_GE(OfferOf("/giveway/v3/ultrasonics").depth, 16);
}

TEST(Definitions, QosIsTheListThatRosbag2Reads) {
  const std::string profile = QosProfileOf("/tf_static");
  EXPECT_TRUE(profile.starts_with("- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"));
  EXPECT_NE(profile.find("  liveliness: 1\n"), std::string::npos);
  EXPECT_NE(profile.find("  avoid_ros_namespace_conventions: false\n"), std::string::npos);
  EXPECT_NE(QosProfileOf("/tf").find("  durability: 2\n"), std::string::npos);
}

}  // namespace
}  // namespace giveway::ros2

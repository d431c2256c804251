// What a recording says of ROS 2 messages: the name and definition of their types, as `ros2
// interface show` has them without comments, and the QoS that their topics were offered with.
#pragma once

#include <string>
#include <string_view>

#include "services/ros2/messages.h"

namespace giveway::ros2 {

// "nav_msgs/msg/Odometry"
std::string_view TypeOf(const Body& body);

// The fields of a type, followed by those of all types in it: the schema encoding `ros2msg`.
// Precondition: the type is one of TypeOf.
std::string DefinitionOf(std::string_view type);

// How the messages of a topic are offered, live and in a recording. ROS 2 keeps transforms that do
// not change for late joiners; all else is as its usual QoS: reliable, volatile.
struct Offer {
  bool transient_local = false;
  int depth = 0;
};
Offer OfferOf(std::string_view topic);

// As rosbag2 reads it from the metadata `offered_qos_profiles` of a channel: numbers, which every
// release takes.
std::string QosProfileOf(std::string_view topic);

}  // namespace giveway::ros2

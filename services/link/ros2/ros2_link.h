// A publisher of ROS 2 messages: a participant of its own that writes topics as ROS 2 nodes read
// them, /tf as rt/tf. No ROS 2 is needed for it. It is no node: `ros2 topic list` shows its topics,
// `ros2 node list` nothing.
//
// A write never waits: the library's thread sends, and of what a slow reader has not acknowledged
// the oldest is replaced.
#pragma once

#include <memory>
#include <string>

#include "services/link/fastdds/link_options.h"
#include "services/ros2/messages.h"

namespace giveway::link {

class Ros2Link {
 public:
  explicit Ros2Link(const LinkOptions& options);  // Throws LinkError.
  ~Ros2Link();
  Ros2Link(const Ros2Link&) = delete;
  Ros2Link& operator=(const Ros2Link&) = delete;

  // Makes the writer of the topic at its first message. False if the library refused the message,
  // or made no writer.
  bool Write(const ros2::Message& message);
  // Removes the writers of all topics below this namespace: "/giveway/v3/".
  void Close(const std::string& name_space);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Encapsulation header (CDR, little-endian) and the message, as a writer serializes it; empty where
// the library cannot.
std::string Encode(const ros2::Message& message);

}  // namespace giveway::link

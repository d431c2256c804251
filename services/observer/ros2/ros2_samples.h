// Recorded samples of the fleet to ROS 2 messages for the same recording. Knows no files and no
// clock: time is the reception of the samples.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/link/observer_link.h"
#include "services/link/raw_link.h"
#include "services/ros2/view.h"

namespace giveway {

// A ROS 2 message as it is recorded.
struct Ros2Sample {
  std::string topic;           // "/giveway/v3/odom"
  std::string_view type;       // "nav_msgs/msg/Odometry"
  std::uint64_t log_ns = 0;    // reception of the sample it was due with, since 1970
  std::uint64_t stamp_ns = 0;  // by the writer of the newest sample it is made of
  std::string bytes;           // encapsulation header and CDR
};

// Takes what an observer received at one time. Beacons that are corrupted, or of another id than
// their writer's, are left out.
void Feed(const link::Observed& observed, ros2::Times at, ros2::View* view);

class Ros2Samples {
 public:
  explicit Ros2Samples(double rate_hz);

  // The messages that are due with this sample.
  std::vector<Ros2Sample> Take(const link::RawSample& sample);

 private:
  ros2::View view_;
};

}  // namespace giveway

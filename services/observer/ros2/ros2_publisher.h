// The fleet as ROS 2 topics, live: what an observer received, converted and published at a fixed
// rate. Messages are stamped with the time at which the observer drained their sample, up to a turn
// of its loop after it was made.
#pragma once

#include <cstdint>

#include "services/link/observer_link.h"
#include "services/link/ros2/ros2_link.h"
#include "services/ros2/view.h"

namespace giveway {

class Ros2Publisher {
 public:
  // Throws LinkError.
  Ros2Publisher(const link::LinkOptions& options, double rate_hz, ros2::View::ProfileOf profile);

  // `now_ns`: since 1970.
  void Publish(const link::Observed& observed, std::uint64_t now_ns);

  std::uint64_t Written() const { return written_; }
  std::uint64_t Refused() const { return refused_; }  // by the library

 private:
  ros2::View view_;
  link::Ros2Link link_;
  std::uint64_t written_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace giveway

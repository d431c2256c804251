// The verb `fleetctl record`: writes samples as they were received to MCAP files. Values in; the
// exit code out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/args/observer_session.h"
#include "services/observer/capture/capture_files.h"
#include "services/ros2/view.h"

namespace giveway::fleetctl {

struct RecordOptions {
  ObserverOptions where;
  CaptureOptions files;
  std::vector<std::string> topics;   // empty: all
  std::optional<double> duration_s;  // stop after that time; absent: never
  bool ros2 = false;                 // the fleet as ROS 2 messages, too
  double ros2_rate_hz = ros2::View::kUsualRate_hz;
  double last_s = 0;  // keeps only the last seconds, and writes them at the end; 0: all
};

// 0 recorded, or ended by Ctrl-C; 1 nothing was received, or a file could not be completed; 2 could
// not run.
int RunRecord(const RecordOptions& options);

}  // namespace giveway::fleetctl

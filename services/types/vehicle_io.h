// Inputs: everything Step may read. Outputs: everything it says. Nothing else goes in or out.
#pragma once

#include <optional>
#include <span>

#include "services/types/beacon.h"
#include "services/types/motor_command.h"
#include "services/types/qos_event.h"
#include "services/types/range_scan.h"
#include "services/types/time.h"

namespace giveway {

struct Inputs {
  SteadyTime now{0};
  // The newest scan since the last step; empty when none came. Its arrival time is `now`.
  std::optional<RangeScan> scan;
  std::span<const ReceivedBeacon> beacons;
  std::span<const QosEvent> events;
  bool leaving = false;  // the process was asked to stop: halt and say good-bye
};

struct Outputs {
  MotorCommand command;
  Beacon beacon;
  bool decision_changed = false;  // against the step before: log it
};

}  // namespace giveway

// Inputs: everything Step may read. Outputs: everything it says. Nothing else goes in or out.
#pragma once

#include <optional>
#include <span>

#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/pose_sensing.h"
#include "services/types/qos_event.h"
#include "services/types/range_scan.h"
#include "services/types/sensor_scan.h"
#include "services/types/signal.h"
#include "services/types/time.h"

namespace giveway {

struct Inputs {
  SteadyTime now{0};
  // The newest scan since the last step; empty when none came. Its arrival time is `now`.
  std::optional<RangeScan> scan;
  std::span<const ReceivedBeacon> beacons;
  std::span<const QosEvent> events;
  // The newest of each further sensor and of each signal head since the last step; null where none.
  const RadarScan* radar = nullptr;
  const LidarScan* lidar = nullptr;
  const CameraScan* camera = nullptr;
  std::span<const SignalState> signals;
  // The world's newest word on this vehicle since the last step: a new epoch brings a new pose.
  std::optional<RosterEntry> roster;
  std::optional<PoseFix> pose_fix;  // the newest since the last step
  bool leaving = false;             // the process was asked to stop: halt and send a leave notice
  bool halting = false;             // the process is about to restart itself: halt
};

struct Outputs {
  MotorCommand command;
  Beacon beacon;
  bool decision_changed = false;  // against the step before: log it
};

}  // namespace giveway

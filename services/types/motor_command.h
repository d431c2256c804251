// What a brain asks of its wheels, and the evidence for it.
#pragma once

#include "services/types/decision.h"
#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/task_progress.h"

namespace giveway {

struct MotorCommand {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;  // the scan this command answers
  WheelSpeeds target;   // rad/s; the world limits acceleration and speed
  Decision decision;
  // True for the first command after the decision changed: what the reaction time is taken from.
  bool decision_changed = false;
  // Peers whose beacon writer this vehicle's reader has matched: the world starts on a full mesh.
  std::uint32_t matched_peers = 0;
  TaskProgress task;  // kept by the world for a new process of the vehicle
};

}  // namespace giveway

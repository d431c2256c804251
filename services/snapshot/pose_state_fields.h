// Which fields a brain remembers of its own pose besides its dead reckoning, for state_fields.h.
// They stand at the end of the state: older images have none of them.
#pragma once

#include "services/recording/recording_fields.h"
#include "services/vehicle/estimation/pose_keeping.h"

namespace giveway {

void Visit(auto& fields, Is<Calibration> auto& calibration) {
  auto& [wheels, with_pose, own] = calibration;
  fields(wheels, with_pose, own);
}

void Visit(auto& fields, Is<PastPose> auto& past) {
  auto& [tick, position, heading] = past;
  fields(tick, position, heading);
}

void Visit(auto& fields, Is<Disagreement> auto& disagreement) {
  auto& [off, off_rad, fixes] = disagreement;
  static_cast<void>(off_rad);  // of a later layout: brain_state.cc
  fields(off, fixes);
}

void Visit(auto& fields, Is<PoseKeeping> auto& keeping) {
  auto& [calibration, past, waiting, agreed, disagreement, fixes_used, fixes_refused, lost,
         wrong_share] = keeping;
  static_cast<void>(wrong_share);  // of a later layout: brain_state.cc
  fields(calibration, past, waiting, agreed, disagreement, fixes_used, fixes_refused, lost);
}

// True where a brain can have come to this.
inline bool IsSound(const PoseKeeping& keeping) {
  const Calibration& calibration = keeping.calibration;
  const auto is_error = [](double share) {
    return share >= -kMostWheelError && share <= kMostWheelError;
  };
  return is_error(calibration.wheels.diameter) && is_error(calibration.wheels.axle) &&
         calibration.own[0] >= 0 && calibration.own[2] >= 0 &&
         keeping.waiting.sigma_position_m >= 0 && keeping.waiting.sigma_heading_rad >= 0 &&
         keeping.wrong_share >= 0 && keeping.wrong_share <= 1;
}

}  // namespace giveway

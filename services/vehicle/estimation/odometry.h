// Dead reckoning that knows its error: the prediction of an extended Kalman filter over the wheel
// encoders. State x, y, heading in the world frame; see Thrun, Burgard, Fox, Probabilistic
// Robotics, ch. 5.4 for the motion model and ch. 3.3 for the filter. What fixes make of it is said
// by pose_keeping.h. Pure.
#pragma once

#include <array>

#include "services/types/math/pose.h"
#include "services/types/state_hash.h"

namespace giveway {

class Odometry {
 public:
  // Knows exactly where it is, or as well as the covariance says.
  explicit Odometry(const Pose& world_from_body = {}, const PoseCovariance& covariance = {});

  // Rolls on for dt_s at the measured wheel speeds, each of which is wrong by a standard deviation
  // of wheel_error times itself, plus guessed_m of displacement where the speeds are a guess.
  // Returns what these errors add: the covariance of the pose after this step, had it been known
  // before.
  PoseCovariance Roll(const DriveGeometry& drive, WheelSpeeds wheels, double dt_s,
                      double wheel_error, double guessed_m);

  const Pose& WorldFromBody() const { return pose_; }
  Vec2 ForwardWorld() const { return heading_.forward_world; }  // the unit vector of its heading
  PoseCovariance Covariance() const;

  void AddTo(StateHash* hash) const;

 private:
  friend struct StateFields;  // services/snapshot
  Pose pose_;
  CachedHeading heading_;
  std::array<double, 9> covariance_{};  // of x, y, heading; row by row
};

}  // namespace giveway

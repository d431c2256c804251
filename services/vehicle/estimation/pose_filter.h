// The arithmetic of pose_keeping.h: a Kalman filter over five numbers, of which one is measured at
// a time (Thrun, Burgard, Fox, Probabilistic Robotics, ch. 3; sequential updates as in Simon,
// Optimal State Estimation, ch. 6.1). No gating: the caller has accepted the measurement. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/types/math/pose.h"
#include "services/types/pose_sensing.h"
#include "services/vehicle/estimation/odometry.h"

namespace giveway {

// What the wheels do otherwise than the drive says, as far as fixes have shown it.
struct Calibration {
  WheelErrors wheels;
  std::array<double, 6> with_pose{};  // covariance of x, y, heading (rows) with diameter and axle
  std::array<double, 3> own{};        // of diameter, of both, of axle
};

// x, y, heading, then the wheels' diameter and axle errors.
enum class PoseNumber : std::uint8_t { kX, kY, kHeading, kDiameter, kAxle };
inline constexpr std::size_t kPoseNumbers = 5;

class PoseFilter {
 public:
  PoseFilter(const Odometry& odometry, const Calibration& calibration);

  // One of the numbers is said to be off by `off` from what it was before any correction, with that
  // variance.
  void Measure(PoseNumber number, double off, double variance);
  // What was measured since `before` is about this vehicle with that probability only: the mean and
  // the covariance of both together (probabilistic data association: Bar-Shalom, Daum and Huang,
  // IEEE Control Systems 29(6), 2009).
  void MixWith(const PoseFilter& before, double probability);
  // The position may be off by that, too; and the heading by so much.
  void Doubt(Vec2 off_world, double heading_rad);
  // Odometry has moved the pose by displacement_world, along heading forward_world; the rims rolled
  // left_m and right_m. Adds the uncertainty that the wheels' systematic errors bring to that
  // displacement.
  void Carry(Vec2 displacement_world, Vec2 forward_world, double left_m, double right_m,
             double axle_m);

  Vec2 Moved() const { return {moved_[0], moved_[1]}; }
  double Rotated() const { return moved_[2]; }
  Odometry TheOdometry() const;
  Calibration TheCalibration() const;

 private:
  double& At(std::size_t row, std::size_t column) {
    return covariance_[row * kPoseNumbers + column];
  }
  double At(std::size_t row, std::size_t column) const {
    return covariance_[row * kPoseNumbers + column];
  }

  Pose pose_;
  WheelErrors wheels_;
  std::array<double, kPoseNumbers> moved_{};  // by corrections
  std::array<double, kPoseNumbers * kPoseNumbers> covariance_{};
};

}  // namespace giveway

#include "services/vehicle/estimation/pose_filter.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr std::size_t kPose = 3;  // of the numbers, the first; two of the wheels after them

}  // namespace

PoseFilter::PoseFilter(const Odometry& odometry, const Calibration& calibration)
    : pose_(odometry.WorldFromBody()), wheels_(calibration.wheels) {
  const PoseCovariance c = odometry.Covariance();
  At(0, 0) = c.xx_m2;
  At(1, 1) = c.yy_m2;
  At(2, 2) = c.hh_rad2;
  At(0, 1) = At(1, 0) = c.xy_m2;
  At(0, 2) = At(2, 0) = c.xh_m_rad;
  At(1, 2) = At(2, 1) = c.yh_m_rad;
  for (std::size_t row = 0; row < kPose; ++row) {
    for (std::size_t i = 0; i < 2; ++i) {
      At(row, kPose + i) = At(kPose + i, row) = calibration.with_pose[2 * row + i];
    }
  }
  At(3, 3) = calibration.own[0];
  At(3, 4) = At(4, 3) = calibration.own[1];
  At(4, 4) = calibration.own[2];
}

void PoseFilter::Measure(PoseNumber number, double off, double variance) {
  const auto of = static_cast<std::size_t>(number);
  const double innovation = At(of, of) + variance;
  std::array<double, kPoseNumbers> gain;
  for (std::size_t i = 0; i < kPoseNumbers; ++i) gain[i] = At(i, of) / innovation;
  const double step = off - moved_[of];
  for (std::size_t i = 0; i < kPoseNumbers; ++i) moved_[i] += gain[i] * step;
  for (std::size_t row = 0; row < kPoseNumbers; ++row) {
    for (std::size_t column = 0; column < kPoseNumbers; ++column) {
      At(row, column) -= gain[row] * gain[column] * innovation;
    }
    At(row, row) = std::max(0.0, At(row, row));
  }
}

void PoseFilter::MixWith(const PoseFilter& before, double probability) {
  const double p = probability;
  std::array<double, kPoseNumbers> apart;
  for (std::size_t i = 0; i < kPoseNumbers; ++i) {
    apart[i] = moved_[i] - before.moved_[i];
    moved_[i] = before.moved_[i] + p * apart[i];
  }
  for (std::size_t row = 0; row < kPoseNumbers; ++row) {
    for (std::size_t column = 0; column < kPoseNumbers; ++column) {
      At(row, column) = p * At(row, column) + (1 - p) * before.At(row, column) +
                        p * (1 - p) * apart[row] * apart[column];
    }
  }
}

void PoseFilter::Doubt(Vec2 off_world, double heading_rad) {
  At(0, 0) += off_world.x * off_world.x;
  At(0, 1) += off_world.x * off_world.y;
  At(1, 0) += off_world.x * off_world.y;
  At(1, 1) += off_world.y * off_world.y;
  At(2, 2) += heading_rad * heading_rad;
}

// F C F' of the pose alone is done. In addition, with G the derivative of the step by the errors:
// F C_pk becomes F C_pk + G C_kk, and C_pp gains F C_pk G' + G C_kp F' + G C_kk G'.
void PoseFilter::Carry(Vec2 displacement_world, Vec2 forward_world, double left_m, double right_m,
                       double axle_m) {
  const double turned_rad = (right_m - left_m) / axle_m;
  const double ahead_m = (right_m - left_m) / 4;  // by an error of the diameter
  const std::array<double, 2> turns = {(right_m + left_m) / (2 * axle_m), -turned_rad};
  // Half of the turn is applied before the displacement.
  const double g[kPose][2] = {{ahead_m * forward_world.x - displacement_world.y * turns[0] / 2,
                               -displacement_world.y * turns[1] / 2},
                              {ahead_m * forward_world.y + displacement_world.x * turns[0] / 2,
                               displacement_world.x * turns[1] / 2},
                              {turns[0], turns[1]}};
  double carried[kPose][2];  // F C_pk
  for (std::size_t i = 0; i < 2; ++i) {
    const double heading = At(2, kPose + i);
    carried[0][i] = At(0, kPose + i) - displacement_world.y * heading;
    carried[1][i] = At(1, kPose + i) + displacement_world.x * heading;
    carried[2][i] = heading;
  }
  for (std::size_t row = 0; row < kPose; ++row) {
    for (std::size_t column = 0; column < kPose; ++column) {
      for (std::size_t i = 0; i < 2; ++i) {
        At(row, column) += carried[row][i] * g[column][i] + g[row][i] * carried[column][i];
        for (std::size_t j = 0; j < 2; ++j) {
          At(row, column) += g[row][i] * At(kPose + i, kPose + j) * g[column][j];
        }
      }
    }
  }
  for (std::size_t row = 0; row < kPose; ++row) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double all =
          carried[row][i] + g[row][0] * At(kPose, kPose + i) + g[row][1] * At(kPose + 1, kPose + i);
      At(row, kPose + i) = At(kPose + i, row) = all;
    }
  }
}

Odometry PoseFilter::TheOdometry() const {
  const Pose pose = {pose_.position_world + Moved(), WrapAngle(pose_.heading_rad + moved_[2])};
  return Odometry(pose, {At(0, 0), At(0, 1), At(1, 1), At(0, 2), At(1, 2), At(2, 2)});
}

Calibration PoseFilter::TheCalibration() const {
  Calibration calibration;
  calibration.wheels = {
      .diameter = std::clamp(wheels_.diameter + moved_[3], -kMostWheelError, kMostWheelError),
      .axle = std::clamp(wheels_.axle + moved_[4], -kMostWheelError, kMostWheelError)};
  for (std::size_t row = 0; row < kPose; ++row) {
    for (std::size_t i = 0; i < 2; ++i) calibration.with_pose[2 * row + i] = At(row, kPose + i);
  }
  calibration.own = {At(3, 3), At(3, 4), At(4, 4)};
  return calibration;
}

}  // namespace giveway

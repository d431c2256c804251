#include "services/vehicle/estimation/odometry.h"

#define EIGEN_DONT_VECTORIZE
#include <Eigen/Core>

namespace giveway {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Vector3 = Eigen::Matrix<double, 3, 1>;
using MapOf3 = Eigen::Map<Matrix3>;

}  // namespace

Odometry::Odometry(const Pose& world_from_body, const PoseCovariance& c)
    : pose_(world_from_body),
      heading_{world_from_body.heading_rad, Forward(world_from_body)},
      covariance_{c.xx_m2,    c.xy_m2,    c.xh_m_rad,  //
                  c.xy_m2,    c.yy_m2,    c.yh_m_rad,  //
                  c.xh_m_rad, c.yh_m_rad, c.hh_rad2} {}

PoseCovariance Odometry::Roll(const DriveGeometry& drive, WheelSpeeds wheels, double dt_s,
                              double wheel_error, double guessed_m) {
  const Vec2 before = pose_.position_world;
  const Vec2 forward = heading_.forward_world;
  pose_ = AdvanceArc(pose_, forward, TwistFromWheels(drive, wheels), dt_s);
  heading_.Follow(pose_);
  const Vec2 displacement = pose_.position_world - before;

  // How the end pose depends on the start pose: F C F' with F = [1 0 -d.y; 0 1 d.x; 0 0 1].
  MapOf3 covariance(covariance_.data());
  covariance.row(0) += -displacement.y * covariance.row(2);
  covariance.row(1) += displacement.x * covariance.row(2);
  covariance.col(0) += -displacement.y * covariance.col(2);
  covariance.col(1) += displacement.x * covariance.col(2);
  // And on the displacement of each wheel.
  const double left = wheel_error * wheels.left_rad_s * drive.wheel_radius_m * dt_s;
  const double right = wheel_error * wheels.right_rad_s * drive.wheel_radius_m * dt_s;
  const Vector3 of_left = left * Vector3(forward.x / 2, forward.y / 2, -1 / drive.axle_m);
  const Vector3 of_right = right * Vector3(forward.x / 2, forward.y / 2, 1 / drive.axle_m);
  covariance += of_left.lazyProduct(of_left.transpose());
  covariance += of_right.lazyProduct(of_right.transpose());
  const double guessed_m2 = guessed_m * guessed_m;
  covariance(0, 0) += guessed_m2;
  covariance(1, 1) += guessed_m2;
  const auto product = [&](int i, int j) {
    return of_left(i) * of_left(j) + of_right(i) * of_right(j);
  };
  return {product(0, 0) + guessed_m2,
          product(0, 1),
          product(1, 1) + guessed_m2,
          product(0, 2),
          product(1, 2),
          product(2, 2)};
}

PoseCovariance Odometry::Covariance() const {
  const auto& c = covariance_;
  return {c[0], c[1], c[4], c[2], c[5], c[8]};
}

void Odometry::AddTo(StateHash* hash) const {
  hash->Add(pose_.position_world.x);
  hash->Add(pose_.position_world.y);
  hash->Add(pose_.heading_rad);
  for (const double entry : covariance_) hash->Add(entry);
}

}  // namespace giveway

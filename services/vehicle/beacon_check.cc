#include "services/vehicle/beacon_check.h"

#include <cmath>
#include <limits>

#include "services/types/fleet_limits.h"
#include "services/types/math.h"

namespace giveway {
namespace {

constexpr double kMaxCoordinate_m = 100'000.0;
constexpr double kMaxSigma_m = 1000.0;
constexpr double kMaxSigma_rad = 2 * kPi;
// Of two variances no covariance is greater than their mean, but for rounding.
constexpr double kRounding_m2 = 1e-9;
constexpr double kMaxRate_m_s2 = 20;

// No part of a vehicle is smaller or larger than this. An axle of next to nothing would turn the
// peer by angles that are no angles any more.
constexpr double kMinLength_m = 0.01;
constexpr double kMaxLength_m = 20;
constexpr double kAboveZero = std::numeric_limits<double>::denorm_min();
constexpr double kHeading_rad = kPi + 1e-9;

// Two numbers at a time: of all that a step does with a far peer's beacon this is the most.
using Lanes = double __attribute__((vector_size(2 * sizeof(double))));

auto AreBetween(Lanes low, Lanes x, Lanes high) { return (x >= low) & (x <= high); }
auto AreWithin(Lanes x, double limit) { return (x >= -limit) & (x <= limit); }

bool AreNumbersInRange(const Beacon& b) {
  const Pose& pose = b.world_from_body;
  const PoseCovariance& c = b.covariance;
  const double mean_m2 = (c.xx_m2 + c.yy_m2) / 2 + kRounding_m2;
  const auto in_range =
      AreWithin(Lanes{b.wheels.left_rad_s, b.wheels.right_rad_s}, kMaxWheel_rad_s) &
      AreBetween(Lanes{}, Lanes{b.cruise_m_s, b.cruise_m_s}, Lanes{} + kMaxSpeed_m_s) &
      AreWithin(Lanes{pose.position_world.x, pose.position_world.y}, kMaxCoordinate_m) &
      AreBetween(Lanes{-kHeading_rad, kMinLength_m}, Lanes{pose.heading_rad, b.body_radius_m},
                 Lanes{kHeading_rad, kMaxLength_m}) &
      AreBetween(Lanes{}, Lanes{c.xx_m2, c.yy_m2}, Lanes{} + kMaxSigma_m * kMaxSigma_m) &
      AreBetween(Lanes{-mean_m2, 0}, Lanes{c.xy_m2, c.hh_rad2},
                 Lanes{mean_m2, kMaxSigma_rad * kMaxSigma_rad}) &
      AreWithin(Lanes{c.xh_m_rad, c.yh_m_rad}, kMaxSigma_m * kMaxSigma_rad) &
      AreBetween(Lanes{} + kMinLength_m, Lanes{b.drive.wheel_radius_m, b.drive.axle_m},
                 Lanes{} + kMaxLength_m) &
      AreBetween(Lanes{} + kAboveZero, Lanes{b.acceleration_m_s2, b.deceleration_m_s2},
                 Lanes{} + kMaxRate_m_s2) &
      AreWithin(Lanes{b.toward_world.x, b.toward_world.y}, kMaxCoordinate_m);
  return (in_range[0] & in_range[1]) != 0;
}

bool IsFinite(const PoseCovariance& c) {
  return std::isfinite(c.xx_m2) && std::isfinite(c.xy_m2) && std::isfinite(c.yy_m2) &&
         std::isfinite(c.xh_m_rad) && std::isfinite(c.yh_m_rad) && std::isfinite(c.hh_rad2);
}

}  // namespace

bool IsFinite(const Beacon& b) {
  return std::isfinite(b.wheels.left_rad_s) && std::isfinite(b.wheels.right_rad_s) &&
         std::isfinite(b.cruise_m_s) && std::isfinite(b.world_from_body.position_world.x) &&
         std::isfinite(b.world_from_body.position_world.y) &&
         std::isfinite(b.world_from_body.heading_rad) && IsFinite(b.covariance) &&
         std::isfinite(b.body_radius_m) && std::isfinite(b.drive.wheel_radius_m) &&
         std::isfinite(b.drive.axle_m) && std::isfinite(b.acceleration_m_s2) &&
         std::isfinite(b.deceleration_m_s2) && std::isfinite(b.toward_world.x) &&
         std::isfinite(b.toward_world.y);
}

bool IsInRange(const Beacon& b) {
  return AreNumbersInRange(b) && b.vehicle != kNobody && b.boot_epoch != 0 && b.seq != 0 &&
         b.mode <= Mode::kLeaving && b.rule <= Rule::kLeaving && b.order.vehicle != kNobody &&
         b.order.waited_ticks <= Number(b.tick) &&
         b.order.speed_bucket <= SpeedBucket(kMaxSpeed_m_s) &&
         (b.order.vehicle != b.vehicle || b.order.speed_bucket == SpeedBucket(b.cruise_m_s));
}

}  // namespace giveway

#include "services/vehicle/beacon_check.h"

#include <cmath>

#include "services/types/fleet_limits.h"
#include "services/types/math.h"

namespace giveway {
namespace {

constexpr double kMaxCoordinate_m = 100'000.0;
constexpr double kMaxSigma_m = 1000.0;
constexpr double kMaxRate_m_s2 = 20;

// No part of a vehicle is smaller or larger than this. An axle of next to nothing would turn the
// peer by angles that are no angles any more.
bool IsLength(double x) { return x >= 0.01 && x <= 20; }

bool Within(double x, double limit) { return x >= -limit && x <= limit; }

}  // namespace

bool IsFinite(const Beacon& b) {
  return std::isfinite(b.wheels.left_rad_s) && std::isfinite(b.wheels.right_rad_s) &&
         std::isfinite(b.cruise_m_s) && std::isfinite(b.world_from_body.position_world.x) &&
         std::isfinite(b.world_from_body.position_world.y) &&
         std::isfinite(b.world_from_body.heading_rad) && std::isfinite(b.sigma_position_m) &&
         std::isfinite(b.sigma_heading_rad) && std::isfinite(b.body_radius_m) &&
         std::isfinite(b.drive.wheel_radius_m) && std::isfinite(b.drive.axle_m) &&
         std::isfinite(b.acceleration_m_s2) && std::isfinite(b.deceleration_m_s2) &&
         std::isfinite(b.toward_world.x) && std::isfinite(b.toward_world.y);
}

bool IsInRange(const Beacon& b) {
  return b.vehicle != kNobody && b.boot_epoch != 0 && b.seq != 0 &&
         Within(b.wheels.left_rad_s, kMaxWheel_rad_s) &&
         Within(b.wheels.right_rad_s, kMaxWheel_rad_s) && b.cruise_m_s >= 0 &&
         b.cruise_m_s <= kMaxSpeed_m_s &&
         Within(b.world_from_body.position_world.x, kMaxCoordinate_m) &&
         Within(b.world_from_body.position_world.y, kMaxCoordinate_m) &&
         Within(b.world_from_body.heading_rad, kPi + 1e-9) && b.sigma_position_m >= 0 &&
         b.sigma_position_m <= kMaxSigma_m && b.sigma_heading_rad >= 0 &&
         b.sigma_heading_rad <= 2 * kPi && IsLength(b.body_radius_m) &&
         IsLength(b.drive.wheel_radius_m) && IsLength(b.drive.axle_m) && b.mode <= Mode::kLeaving &&
         b.rule <= Rule::kLeaving && b.order.vehicle != kNobody && b.acceleration_m_s2 > 0 &&
         b.acceleration_m_s2 <= kMaxRate_m_s2 && b.deceleration_m_s2 > 0 &&
         b.deceleration_m_s2 <= kMaxRate_m_s2 && Within(b.toward_world.x, kMaxCoordinate_m) &&
         Within(b.toward_world.y, kMaxCoordinate_m) && b.order.waited_ticks <= Number(b.tick) &&
         b.order.speed_bucket <= SpeedBucket(kMaxSpeed_m_s) &&
         (b.order.vehicle != b.vehicle || b.order.speed_bucket == SpeedBucket(b.cruise_m_s));
}

}  // namespace giveway

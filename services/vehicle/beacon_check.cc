#include "services/vehicle/beacon_check.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
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

// Within these every number of a beacon is.
constexpr Beacon kLeast = {
    .wheels = {-kMaxWheel_rad_s, -kMaxWheel_rad_s},
    .cruise_m_s = 0,
    .world_from_body = {{-kMaxCoordinate_m, -kMaxCoordinate_m}, -kHeading_rad},
    .covariance = {.xx_m2 = 0,
                   .xy_m2 = -kMaxSigma_m * kMaxSigma_m,
                   .yy_m2 = 0,
                   .xh_m_rad = -kMaxSigma_m * kMaxSigma_rad,
                   .yh_m_rad = -kMaxSigma_m * kMaxSigma_rad,
                   .hh_rad2 = 0},
    .body_radius_m = kMinLength_m,
    .drive = {kMinLength_m, kMinLength_m},
    .acceleration_m_s2 = kAboveZero,
    .deceleration_m_s2 = kAboveZero,
    .toward_world = {-kMaxCoordinate_m, -kMaxCoordinate_m},
};
constexpr Beacon kMost = {
    .wheels = {kMaxWheel_rad_s, kMaxWheel_rad_s},
    .cruise_m_s = kMaxSpeed_m_s,
    .world_from_body = {{kMaxCoordinate_m, kMaxCoordinate_m}, kHeading_rad},
    .covariance = {.xx_m2 = kMaxSigma_m * kMaxSigma_m,
                   .xy_m2 = kMaxSigma_m * kMaxSigma_m,
                   .yy_m2 = kMaxSigma_m * kMaxSigma_m,
                   .xh_m_rad = kMaxSigma_m * kMaxSigma_rad,
                   .yh_m_rad = kMaxSigma_m * kMaxSigma_rad,
                   .hh_rad2 = kMaxSigma_rad * kMaxSigma_rad},
    .body_radius_m = kMaxLength_m,
    .drive = {kMaxLength_m, kMaxLength_m},
    .acceleration_m_s2 = kMaxRate_m_s2,
    .deceleration_m_s2 = kMaxRate_m_s2,
    .toward_world = {kMaxCoordinate_m, kMaxCoordinate_m},
};

// The numbers lie side by side, and are looked at two at a time: of all that a step does with a far
// peer's beacon this is the most.
constexpr std::size_t kNumbersAt = offsetof(Beacon, wheels);
constexpr std::size_t kNumbers = 19;
static_assert(kNumbersAt + kNumbers * sizeof(double) ==
              offsetof(Beacon, toward_world) + sizeof(Vec2));

using Lanes = double __attribute__((vector_size(2 * sizeof(double))));
using Bits = std::int32_t __attribute__((vector_size(sizeof(Lanes))));

Lanes TwoNumbers(const Beacon& beacon, std::size_t first) {
  Lanes lanes;
  std::memcpy(&lanes, reinterpret_cast<const char*>(&beacon) + kNumbersAt + first * sizeof(double),
              sizeof lanes);
  return lanes;
}

bool AreNumbersInRange(const Beacon& b) {
  const auto in_range = [&b](std::size_t first) {
    const Lanes x = TwoNumbers(b, first);
    return std::bit_cast<Bits>(x >= TwoNumbers(kLeast, first)) &
           std::bit_cast<Bits>(x <= TwoNumbers(kMost, first));
  };
  Bits all = in_range(kNumbers - 2);  // of an odd number the last but one is looked at twice
  for (std::size_t i = 0; i + 1 < kNumbers; i += 2) all &= in_range(i);
  const PoseCovariance& c = b.covariance;
  const double mean_m2 = (c.xx_m2 + c.yy_m2) / 2 + kRounding_m2;
  return (all[0] & all[2]) != 0 && Magnitude(c.xy_m2) <= mean_m2;
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

#include "services/vehicle/estimation/beacon_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

// A vehicle that is unsure by more does not know where it is at all.
constexpr double kMaxSigma_m = 1000.0;
constexpr double kMaxSigma_rad = 2 * kPi;
// Of two variances no covariance is greater than their mean, but for rounding.
constexpr double kRounding_m2 = 1e-9;
constexpr double kMaxRate_m_s2 = 20;  // 2 g: no wheel holds more

// No part of a vehicle is smaller or larger than this. An axle of next to nothing would turn the
// peer by angles that are no angles any more.
constexpr double kMinLength_m = 0.01;
constexpr double kMaxLength_m = 20;
constexpr double kAboveZero = std::numeric_limits<double>::denorm_min();
constexpr double kHeading_rad = kPi + 1e-9;

constexpr std::size_t kNumbers = 19;  // of a beacon that are not whole
using Numbers = std::array<double, kNumbers>;

// In the order of kNames.
constexpr Numbers NumbersOf(const Beacon& b) {
  const PoseCovariance& c = b.covariance;
  const Pose& pose = b.world_from_body;
  return {b.wheels.left_rad_s,
          b.wheels.right_rad_s,
          b.cruise_m_s,
          pose.position_world.x,
          pose.position_world.y,
          pose.heading_rad,
          c.xx_m2,
          c.xy_m2,
          c.yy_m2,
          c.xh_m_rad,
          c.yh_m_rad,
          c.hh_rad2,
          b.body_radius_m,
          b.drive.wheel_radius_m,
          b.drive.axle_m,
          b.acceleration_m_s2,
          b.deceleration_m_s2,
          b.toward_world.x,
          b.toward_world.y};
}

// Within these every number of a beacon is.
constexpr Numbers kLowest = NumbersOf({
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
});
constexpr Numbers kHighest = NumbersOf({
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
});

constexpr std::array<const char*, kNumbers> kNames = {
    "left_rad_s",          "right_rad_s",         "cruise_m_s",
    "world_from_body.x_m", "world_from_body.y_m", "world_from_body.heading_rad",
    "covariance.xx_m2",    "covariance.xy_m2",    "covariance.yy_m2",
    "covariance.xh_m_rad", "covariance.yh_m_rad", "covariance.hh_rad2",
    "body_radius_m",       "wheel_radius_m",      "axle_m",
    "acceleration_m_s2",   "deceleration_m_s2",   "toward_x_m",
    "toward_y_m"};

double MostCovariance(const PoseCovariance& c) { return (c.xx_m2 + c.yy_m2) / 2 + kRounding_m2; }

// Nearly all beacons pass: counts without a branch for each number, in a type as wide as they are,
// so that the compiler compares several at a time.
bool AreWithin(const Numbers& numbers) {
  std::int64_t within = 0;
  for (std::size_t i = 0; i < kNumbers; ++i) {
    within += numbers[i] >= kLowest[i] && numbers[i] <= kHighest[i] ? 1 : 0;
  }
  return within == kNumbers;
}

std::optional<FieldFault> NumberFault(const Beacon& b) {
  const Numbers numbers = NumbersOf(b);
  for (std::size_t i = 0; !AreWithin(numbers) && i < kNumbers; ++i) {
    if (numbers[i] >= kLowest[i] && numbers[i] <= kHighest[i]) continue;
    return FieldFault{kNames[i], numbers[i], kLowest[i], kHighest[i]};
  }
  const double most_m2 = MostCovariance(b.covariance);
  if (Magnitude(b.covariance.xy_m2) <= most_m2) return std::nullopt;
  return FieldFault{"covariance.xy_m2", b.covariance.xy_m2, -most_m2, most_m2};
}

}  // namespace

bool IsFinite(const Beacon& b) {
  return std::ranges::all_of(NumbersOf(b), [](double x) { return std::isfinite(x); });
}

std::optional<FieldFault> FaultOf(const Beacon& b) {
  constexpr double kMostWhole = std::numeric_limits<std::uint32_t>::max();
  const auto fault = [](const char* field, std::uint32_t value, double least, double most) {
    return FieldFault{field, static_cast<double>(value), least, most};
  };
  if (b.vehicle == kNoVehicle) return fault("vehicle", 0, 1, kMostWhole);
  if (b.boot_epoch == 0) return fault("boot_epoch", 0, 1, kMostWhole);
  if (b.seq == 0) return fault("seq", 0, 1, kMostWhole);
  if (const auto number = NumberFault(b)) return number;
  const auto mode = static_cast<std::uint32_t>(b.mode);
  const auto rule = static_cast<std::uint32_t>(b.rule);
  if (b.mode > Mode::kLeaving) return fault("mode", mode, 0, double(Mode::kLeaving));
  if (b.rule > kLastRule) return fault("rule", rule, 0, double(kLastRule));
  const PriorityKey& order = b.order;
  // No world, no tick: it may have waited before its process was started again.
  if (b.world_epoch != kNoEpoch && order.waited_ticks > Number(b.tick)) {
    return fault("order_waited_ticks", order.waited_ticks, 0, Number(b.tick));
  }
  // Its own key carries its own cruise speed, rounded; an inherited key that of another vehicle.
  const bool own = order.vehicle == b.vehicle;
  const double least = own ? SpeedBucket(b.cruise_m_s) : 0;
  const double most = SpeedBucket(own ? b.cruise_m_s : kMaxSpeed_m_s);
  if (order.speed_bucket < least || order.speed_bucket > most) {
    return fault("order_speed_bucket", order.speed_bucket, least, most);
  }
  if (order.vehicle == kNoVehicle) return fault("order_vehicle", 0, 1, kMostWhole);
  return std::nullopt;
}

bool IsInRange(const Beacon& b) { return !FaultOf(b); }

}  // namespace giveway

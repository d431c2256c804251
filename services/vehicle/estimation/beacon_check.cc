#include "services/vehicle/estimation/beacon_check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"

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

constexpr std::size_t kNumbers = 19;
using Numbers = std::array<double, kNumbers>;

// The numbers of a beacon, which lie in it side by side in this order.
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
constexpr std::size_t kNumbersAt = offsetof(Beacon, wheels);
static_assert(kNumbersAt + sizeof(Numbers) == offsetof(Beacon, toward_world) + sizeof(Vec2));

constexpr Numbers kLowest = NumbersOf(kLeast);
constexpr Numbers kHighest = NumbersOf(kMost);

bool AreWithin(const Numbers& numbers) {
  for (std::size_t i = 0; i < kNumbers; ++i) {
    if (!(numbers[i] >= kLowest[i] && numbers[i] <= kHighest[i])) return false;
  }
  return true;
}

constexpr std::array<const char*, kNumbers> kNames = {
    "left_rad_s",          "right_rad_s",         "cruise_m_s",
    "world_from_body.x_m", "world_from_body.y_m", "world_from_body.heading_rad",
    "covariance.xx_m2",    "covariance.xy_m2",    "covariance.yy_m2",
    "covariance.xh_m_rad", "covariance.yh_m_rad", "covariance.hh_rad2",
    "body_radius_m",       "wheel_radius_m",      "axle_m",
    "acceleration_m_s2",   "deceleration_m_s2",   "toward_x_m",
    "toward_y_m"};

// Fast path: for positive doubles the upper 32 bits (sign, exponent, leading digits) order like the
// value, so four range checks fit one SIMD compare; only values near a bound take the exact path.
// These checks are most of the cost of a far peer's beacon.
static_assert(std::endian::native == std::endian::little);
using Halves = std::uint32_t __attribute__((vector_size(4 * sizeof(std::uint32_t))));
using SignedHalves = std::int32_t __attribute__((vector_size(sizeof(Halves))));

// What the upper halves of four numbers in a row are between. Where the lowest and the highest are
// the same but for the sign, the sign is passed over.
struct Bounds {
  alignas(Halves) std::array<std::uint32_t, 4> digits;
  alignas(Halves) std::array<std::uint32_t, 4> least;
  alignas(Halves) std::array<std::uint32_t, 4> most;
};

constexpr std::uint32_t UpperHalf(double number) {
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(number) >> 32);
}

constexpr Bounds BoundsFrom(std::size_t first) {
  Bounds bounds{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double lowest = kLowest[first + i];
    bounds.digits[i] = lowest < 0 ? 0x7fff'ffff : 0xffff'ffff;
    bounds.least[i] = lowest > 0 ? UpperHalf(lowest) + 1 : 0;
    bounds.most[i] = UpperHalf(kHighest[first + i]) - 1;
  }
  return bounds;
}

// No sign bit is set where all four numbers are well within.
template <std::size_t First>
[[gnu::always_inline]] inline Halves Outside(const Beacon& beacon) {
  static constexpr Bounds kBounds = BoundsFrom(First);
  const char* from = reinterpret_cast<const char*>(&beacon) + kNumbersAt + First * sizeof(double);
  Halves two, two_more, digits, least, most;
  std::memcpy(&two, from, sizeof two);
  std::memcpy(&two_more, from + sizeof two, sizeof two_more);
  std::memcpy(&digits, kBounds.digits.data(), sizeof digits);
  std::memcpy(&least, kBounds.least.data(), sizeof least);
  std::memcpy(&most, kBounds.most.data(), sizeof most);
  const Halves x = __builtin_shufflevector(two, two_more, 1, 3, 5, 7) & digits;
  const auto above = std::bit_cast<SignedHalves>(x) > std::bit_cast<SignedHalves>(most);
  return x | (x - least) | std::bit_cast<Halves>(above);
}

double MostCovariance(const PoseCovariance& c) { return (c.xx_m2 + c.yy_m2) / 2 + kRounding_m2; }

bool AreNumbersInRange(const Beacon& b) {
  const Halves outside =
      Outside<0>(b) | Outside<4>(b) | Outside<8>(b) | Outside<12>(b) | Outside<15>(b);
  const SignedHalves signs = std::bit_cast<SignedHalves>(outside) < 0;
  const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(signs);
  const bool all_well_within = (halves[0] | halves[1]) == 0;
  if (!all_well_within && !AreWithin(NumbersOf(b))) return false;
  const PoseCovariance& c = b.covariance;
  return Magnitude(c.xy_m2) <= MostCovariance(c);
}

std::optional<FieldFault> NumberFault(const Beacon& b) {
  const Numbers numbers = NumbersOf(b);
  for (std::size_t i = 0; i < kNumbers; ++i) {
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

bool IsInRange(const Beacon& b) {
  return AreNumbersInRange(b) && b.vehicle != kNobody && b.boot_epoch != 0 && b.seq != 0 &&
         b.mode <= Mode::kLeaving && b.rule <= kLastRule && b.order.vehicle != kNobody &&
         b.order.waited_ticks <= Number(b.tick) &&
         b.order.speed_bucket <= SpeedBucket(kMaxSpeed_m_s) &&
         (b.order.vehicle != b.vehicle || b.order.speed_bucket == SpeedBucket(b.cruise_m_s));
}

std::optional<FieldFault> FaultOf(const Beacon& b) {
  constexpr double kMostWhole = std::numeric_limits<std::uint32_t>::max();
  const auto fault = [](const char* field, std::uint32_t value, double least, double most) {
    return FieldFault{field, static_cast<double>(value), least, most};
  };
  if (b.vehicle == kNobody) return fault("vehicle", 0, 1, kMostWhole);
  if (b.boot_epoch == 0) return fault("boot_epoch", 0, 1, kMostWhole);
  if (b.seq == 0) return fault("seq", 0, 1, kMostWhole);
  if (const auto number = NumberFault(b)) return number;
  const auto mode = static_cast<std::uint32_t>(b.mode);
  const auto rule = static_cast<std::uint32_t>(b.rule);
  if (b.mode > Mode::kLeaving) return fault("mode", mode, 0, double(Mode::kLeaving));
  if (b.rule > kLastRule) return fault("rule", rule, 0, double(kLastRule));
  const OrderKey& order = b.order;
  if (order.waited_ticks > Number(b.tick)) {
    return fault("order_waited_ticks", order.waited_ticks, 0, Number(b.tick));
  }
  // Its own key carries its own cruise speed, rounded; an inherited key that of another vehicle.
  const bool own = order.vehicle == b.vehicle;
  const double least = own ? SpeedBucket(b.cruise_m_s) : 0;
  const double most = SpeedBucket(own ? b.cruise_m_s : kMaxSpeed_m_s);
  if (order.speed_bucket < least || order.speed_bucket > most) {
    return fault("order_speed_bucket", order.speed_bucket, least, most);
  }
  if (order.vehicle == kNobody) return fault("order_vehicle", 0, 1, kMostWhole);
  return std::nullopt;
}

}  // namespace giveway

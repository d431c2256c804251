#include "sim_world/sensors/sonar_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

// With other compilers and on other machines the plain width serves.
#if defined(__x86_64__) && defined(__GNUC__)
#define GIVEWAY_X86_SIMD 1
#include <immintrin.h>
#endif

namespace giveway::sim {
namespace {

constexpr long long kAllButTheSign = std::numeric_limits<long long>::max();

// By four bits: the indices of the set bits, 16 bits each, the first lowest.
constexpr std::array<std::uint64_t, 16> kPlaces = [] {
  std::array<std::uint64_t, 16> places{};
  for (std::uint32_t bits = 0; bits < places.size(); ++bits) {
    int found = 0;
    for (std::uint64_t place = 0; place < 4; ++place) {
      if ((bits >> place & 1) != 0) places[bits] |= place << (16 * found++);
    }
  }
  return places;
}();

static_assert(std::endian::native == std::endian::little, "places are written as one number");
static_assert(kSectorCount == 4 && kSectorSize == 4 && kNearListSize % 4 == 0);

namespace plain {
#include "sim_world/sensors/sonar_kernel_width.inc"
}  // namespace plain

#ifdef GIVEWAY_X86_SIMD
#define GIVEWAY_WIDTH_AVX2 \
  1  // __AVX2__ does not follow the pragma where preprocessing is a step apart
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#include "sim_world/sensors/sonar_kernel_width.inc"
}  // namespace avx2
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq,avx512vl"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl")
#endif
namespace avx512 {
#include "sim_world/sensors/sonar_kernel_width.inc"
}  // namespace avx512
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

Vec2 Receiver::ToBody(Vec2 point_world) const {
  const Vec2 offset_world = point_world - position_world;
  return {Dot(x_axis_world, offset_world), Cross(x_axis_world, offset_world)};
}

Vec2 Receiver::ToWorld(Vec2 point_body) const {
  return position_world + point_body.x * x_axis_world + point_body.y * Left(x_axis_world);
}

void NearDiscs::Add(Vec2 centre, double radius) {
  x[count] = centre.x;
  y[count] = centre.y;
  radius_m[count] = radius;
  in_reach.of[in_reach.count++] = static_cast<std::uint16_t>(count++);
}

void NearSegments::Add(Vec2 from, Vec2 to) {
  from_x[count] = from.x;
  from_y[count] = from.y;
  to_x[count] = to.x;
  to_y[count] = to.y;
  in_reach.of[in_reach.count++] = static_cast<std::uint16_t>(count++);
}

bool HasSimd(SimdWidth width) {
  if (width == SimdWidth::kPlain) return true;
#ifdef GIVEWAY_X86_SIMD
  if (width == SimdWidth::kAvx2) return __builtin_cpu_supports("avx2") != 0;
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0;
#else
  return false;
#endif
}

const SonarKernel& KernelOf(SimdWidth width) {
#ifdef GIVEWAY_X86_SIMD
  if (width == SimdWidth::kAvx512) return avx512::kKernel;
  if (width == SimdWidth::kAvx2) return avx2::kKernel;
#endif
  static_cast<void>(width);
  return plain::kKernel;
}

SimdWidth FastestSimd() {
  if (HasSimd(SimdWidth::kAvx512)) return SimdWidth::kAvx512;
  return HasSimd(SimdWidth::kAvx2) ? SimdWidth::kAvx2 : SimdWidth::kPlain;
}

}  // namespace giveway::sim

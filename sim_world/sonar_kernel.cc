#include "sim_world/sonar_kernel.h"

#include <cmath>

// With other compilers and on other machines the plain width serves.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define GIVEWAY_X86_SIMD 1
#endif

// The bodies below are compiled once for every width, into functions that allow its instructions.
#define GIVEWAY_EVERY_WIDTH [[gnu::always_inline]] inline

namespace giveway::sim {
namespace {

constexpr std::size_t kLanes = kSensorCount;

GIVEWAY_EVERY_WIDTH void HearDisc(const ConeRing& ring, double x, double y, double radius_m,
                                  Incidence incidence, Lanes* range_m) {
  const double squared_radius = radius_m * radius_m;
  const double most_beyond_edge_m = radius_m * incidence.sin_max;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double offset_x = x - ring.apex_x.of[i];
    const double offset_y = y - ring.apex_y.of[i];
    const double ahead = ring.axis_x.of[i] * offset_x + ring.axis_y.of[i] * offset_y;
    const double aside = std::abs(ring.axis_x.of[i] * offset_y - ring.axis_y.of[i] * offset_x);
    const double squared_distance = ahead * ahead + aside * aside;
    const double beyond_edge = ring.cos_half * aside - ring.sin_half * ahead;
    const double along_edge = ring.cos_half * ahead + ring.sin_half * aside;
    const bool inside = beyond_edge <= 0;
    // One root serves both cases. It may be of a negative number, and so of nothing, only where
    // the disc is not heard.
    const double half_chord_squared = squared_radius - beyond_edge * beyond_edge;
    const double squared_root = inside ? squared_distance : half_chord_squared;
    const double from_m = inside ? radius_m : along_edge;
    const double clear_m = std::abs(std::sqrt(squared_root) - from_m);
    const bool heard = inside | ((along_edge > 0) & (beyond_edge <= most_beyond_edge_m));
    const double answer_m = squared_distance <= squared_radius ? 0 : heard ? clear_m : kSilence_m;
    range_m->of[i] = answer_m < range_m->of[i] ? answer_m : range_m->of[i];
  }
}

// Keeps of [low, high] the part of the segment on which at_from + parameter * change >= 0.
GIVEWAY_EVERY_WIDTH void Clip(double at_from, double change, double* low, double* high) {
  const double parameter = -at_from / change;
  *low = ((change > 0) & (parameter > *low)) ? parameter : *low;
  *high = ((change < 0) & (parameter < *high)) ? parameter : *high;
  *high = ((change == 0) & (at_from < 0)) ? -1 : *high;  // below any low: nothing is left
}

GIVEWAY_EVERY_WIDTH void HearSegment(const ConeRing& ring, Vec2 from, Vec2 to, Incidence incidence,
                                     Lanes* range_m) {
  const double squared_cos_max = incidence.cos_max * incidence.cos_max;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double axis_x = ring.axis_x.of[i];
    const double axis_y = ring.axis_y.of[i];
    const double from_x = from.x - ring.apex_x.of[i];
    const double from_y = from.y - ring.apex_y.of[i];
    const double to_x = to.x - ring.apex_x.of[i];
    const double to_y = to.y - ring.apex_y.of[i];
    // As the transducer sees it: along its axis and to the left of it.
    const double from_u = axis_x * from_x + axis_y * from_y;
    const double from_v = axis_x * from_y - axis_y * from_x;
    const double along_u = (axis_x * to_x + axis_y * to_y) - from_u;
    const double along_v = (axis_x * to_y - axis_y * to_x) - from_v;
    const double squared_length = along_u * along_u + along_v * along_v;
    const double free_foot = -(from_u * along_u + from_v * along_v) / squared_length;
    const double low_foot = free_foot > 0 ? free_foot : 0;  // also where a point divides by 0
    const double foot = low_foot < 1 ? low_foot : 1;
    const double foot_u = from_u + foot * along_u;
    const double foot_v = from_v + foot * along_v;
    const bool on_it = foot_u * foot_u + foot_v * foot_v <= kOnTheWall_m * kOnTheWall_m;
    double low = 0;
    double high = 1;
    Clip(ring.sin_half * from_u + -ring.cos_half * from_v,
         ring.sin_half * along_u + -ring.cos_half * along_v, &low, &high);
    Clip(ring.sin_half * from_u + ring.cos_half * from_v,
         ring.sin_half * along_u + ring.cos_half * along_v, &low, &high);
    const double at_least = foot < low ? low : foot;
    const double nearest = high < at_least ? high : at_least;
    const double near_u = from_u + nearest * along_u;
    const double near_v = from_v + nearest * along_v;
    const double squared_range = near_u * near_u + near_v * near_v;
    const double across = from_u * along_v - from_v * along_u;
    const bool faces = across * across >= squared_cos_max * squared_range * squared_length;
    const bool heard = (low <= high) & faces;
    const double answer_m = on_it ? 0 : heard ? std::sqrt(squared_range) : kSilence_m;
    range_m->of[i] = answer_m < range_m->of[i] ? answer_m : range_m->of[i];
  }
}

GIVEWAY_EVERY_WIDTH void HearEachDisc(const ConeRing& ring, const NearDiscs& discs,
                                      Incidence incidence, Lanes* range_m) {
  Lanes nearest_m = *range_m;
  for (std::size_t i = 0; i < discs.count; ++i) {
    HearDisc(ring, discs.x[i], discs.y[i], discs.radius_m[i], incidence, &nearest_m);
  }
  *range_m = nearest_m;
}

GIVEWAY_EVERY_WIDTH void HearEachSegment(const ConeRing& ring, const NearSegments& segments,
                                         Incidence incidence, Lanes* range_m) {
  Lanes nearest_m = *range_m;
  for (std::size_t i = 0; i < segments.count; ++i) {
    HearSegment(ring, segments.from[i], segments.to[i], incidence, &nearest_m);
  }
  *range_m = nearest_m;
}

#define GIVEWAY_KERNEL(Name, ...)                                                         \
  __VA_ARGS__ void HearDiscs##Name(const ConeRing& ring, const NearDiscs& discs,          \
                                   Incidence incidence, Lanes* range_m) {                 \
    HearEachDisc(ring, discs, incidence, range_m);                                        \
  }                                                                                       \
  __VA_ARGS__ void HearSegments##Name(const ConeRing& ring, const NearSegments& segments, \
                                      Incidence incidence, Lanes* range_m) {              \
    HearEachSegment(ring, segments, incidence, range_m);                                  \
  }                                                                                       \
  constexpr SonarKernel k##Name##Kernel = {HearDiscs##Name, HearSegments##Name};

GIVEWAY_KERNEL(Plain)
#ifdef GIVEWAY_X86_SIMD
GIVEWAY_KERNEL(Avx2, [[gnu::target("avx2")]])
GIVEWAY_KERNEL(Avx512, [[gnu::target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")]])
#endif

}  // namespace

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
  if (width == SimdWidth::kAvx512) return kAvx512Kernel;
  if (width == SimdWidth::kAvx2) return kAvx2Kernel;
#endif
  static_cast<void>(width);
  return kPlainKernel;
}

SimdWidth FastestSimd() {
  if (HasSimd(SimdWidth::kAvx512)) return SimdWidth::kAvx512;
  return HasSimd(SimdWidth::kAvx2) ? SimdWidth::kAvx2 : SimdWidth::kPlain;
}

}  // namespace giveway::sim

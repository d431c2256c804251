// The formulas of sonar_cone.h for one vehicle's 16 cones against lists of objects, branch-free and
// in arrays, so that the compiler makes vector instructions of them. The same bits come out of
// every width, because each lane does the reference's operations in the reference's order.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "services/types/profile.h"
#include "sim_world/sonar_cone.h"

namespace giveway::sim {

// One number a transducer, as wide as the widest vector register needs it.
struct alignas(64) Lanes {
  std::array<double, kSensorCount> of{};

  friend bool operator==(const Lanes&, const Lanes&) = default;
};

// What a transducer hears that nothing answers.
inline constexpr double kSilence_m = std::numeric_limits<double>::infinity();

// A ring of cones in the body frame; all have the same opening.
struct ConeRing {
  Lanes apex_x;
  Lanes apex_y;
  Lanes axis_x;
  Lanes axis_y;
  double cos_half = 1;
  double sin_half = 0;

  friend bool operator==(const ConeRing&, const ConeRing&) = default;
};

// Objects near one vehicle, in its body frame. Kept on the stack; a full list is heard and emptied.
inline constexpr std::size_t kNearListSize = 128;

struct NearDiscs {
  std::size_t count = 0;
  std::array<double, kNearListSize> x;
  std::array<double, kNearListSize> y;
  std::array<double, kNearListSize> radius_m;
};

struct NearSegments {
  std::size_t count = 0;
  std::array<Vec2, kNearListSize> from;
  std::array<Vec2, kNearListSize> to;
};

// Lower each range to that of the nearest object of the list, as RangeToDisc and RangeToSegment
// state it, but without the limit of range.
struct SonarKernel {
  void (*hear_discs)(const ConeRing& ring, const NearDiscs& discs, Incidence incidence,
                     Lanes* range_m);
  void (*hear_segments)(const ConeRing& ring, const NearSegments& segments, Incidence incidence,
                        Lanes* range_m);
};

enum class SimdWidth { kPlain, kAvx2, kAvx512 };

// Whether this CPU has what the width needs. What is hidden from the C library is not hidden here.
bool HasSimd(SimdWidth width);
const SonarKernel& KernelOf(SimdWidth width);
// The widest this CPU has.
SimdWidth FastestSimd();

}  // namespace giveway::sim

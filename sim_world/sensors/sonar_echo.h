// How a transducer measures the nearest thing that echoes: the faults of the typical tier. And its
// random numbers: each is derived from its purpose, so that no draw shifts another.
#pragma once

#include <cstdint>

#include "services/types/math/random.h"
#include "services/types/range_scan.h"
#include "services/types/scenario.h"
#include "sim_world/sensors/sonar_kernel.h"

namespace giveway::sim {

// The numbers of one firing of one transducer; `when` is the tick, or the slot where slots are
// kept.
Random FiringRandom(std::uint32_t seed, VehicleId vehicle, std::uint64_t when,
                    std::size_t transducer);

// `range_m` as it is measured, kSilence_m if nothing answers. The firing may hear nothing by
// chance; what is nearer than the blind zone reads as its rim, exactly, because the ring-down hides
// when it came; the rest is noisy but stays between that rim and max_range_m.
double Measured(double range_m, const SonarModel& model, double max_range_m, Random random);

// The reading of one firing: an echo at `range_m`, or clear if that is kSilence_m.
inline RangeReading ReadingOf(double range_m, Tick tick, double fired_before_s = 0) {
  const bool silent = range_m == kSilence_m;
  return {.kind = silent ? Echo::kClear : Echo::kEcho,
          .range_m = silent ? 0 : range_m,
          .tick = tick,
          .fired_before_s = fired_before_s};
}

}  // namespace giveway::sim

// Durations as whole ticks.
#pragma once

#include <cstdint>

#include "services/types/time.h"

namespace giveway::sim {

// The fewest ticks that last at least `duration`; 0 for a duration that is not positive.
constexpr std::uint32_t TicksCovering(Nanoseconds duration, Nanoseconds period) {
  if (duration <= Nanoseconds::zero()) return 0;
  return static_cast<std::uint32_t>((duration.count() + period.count() - 1) / period.count());
}

}  // namespace giveway::sim

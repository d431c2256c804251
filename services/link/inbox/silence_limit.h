// How long a sender that says something each tick may be silent before it is taken for gone. Pure.
#pragma once

#include <algorithm>

#include "services/types/time.h"

namespace giveway::link {

// Some of what is sent is lost, and a busy sender comes late.
inline constexpr int kSilentTicks = 5;

// `least` holds where ticks are short. `tick_period` 0: not known.
constexpr Nanoseconds SilenceLimit(Nanoseconds least, Nanoseconds tick_period) {
  return std::max(least, kSilentTicks * tick_period);
}

}  // namespace giveway::link

// Time as a value. No clock is read in this module: the owner of a clock passes the time in.
#pragma once

#include <chrono>
#include <cstdint>

namespace giveway {

using Nanoseconds = std::chrono::nanoseconds;

// A point on the receiver's steady clock, counted from an arbitrary origin of that process.
// In lockstep and virtual time it is the tick times the tick period.
using SteadyTime = std::chrono::nanoseconds;

constexpr double Seconds(Nanoseconds d) { return static_cast<double>(d.count()) * 1e-9; }
constexpr double Milliseconds(Nanoseconds d) { return static_cast<double>(d.count()) * 1e-6; }

// The duration nearest to `seconds`; `seconds` is finite and below 2^33.
constexpr Nanoseconds FromSeconds(double seconds) {
  return Nanoseconds{static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5))};
}

// The fewest ticks that last at least `duration`; 0 for a duration that is not positive.
constexpr std::uint32_t TicksCovering(Nanoseconds duration, Nanoseconds period) {
  if (duration <= Nanoseconds::zero()) return 0;
  return static_cast<std::uint32_t>((duration.count() + period.count() - 1) / period.count());
}

}  // namespace giveway

// Conservative advancement: how far time may continue before a gap can have closed. Rigorous to
// second order: a value that changes at a known rate and bends at most so much.
#pragma once

#include <limits>

#include "services/types/math/math.h"

namespace giveway::sim {

// Below this closing speed touching shells are taken as sliding: rounding must not lock a body that
// drives along a wall.
inline constexpr double kSliding_m_s = 1e-9;
// How far a touching body that does not close in may sink in before its motion is checked again.
inline constexpr double kSink_m = 1e-8;

// Over a step d the gap stays above gap + rate d - bend d^2 / 2; this is the d at which that bound
// has fallen by `fall`.
inline double SafeStep(double rate_m_s, double bend_m_s2, double fall_m) {
  if (bend_m_s2 > 0) {
    const double root = Sqrt(rate_m_s * rate_m_s + 2 * bend_m_s2 * fall_m);
    // Two forms of the same root; each avoids cancellation on its side.
    return rate_m_s > 0 ? (rate_m_s + root) / bend_m_s2 : 2 * fall_m / (root - rate_m_s);
  }
  return rate_m_s < 0 ? fall_m / -rate_m_s : std::numeric_limits<double>::infinity();
}

}  // namespace giveway::sim

// The times of a soak, from its duration and its fleet. Pure.
#pragma once

#include <algorithm>
#include <cstddef>

namespace giveway::fleetctl {

// A fleet takes ten to start.
inline constexpr double kLeastSoak_s = 30;

// Seconds since the start signal.
struct SoakPhases {
  double faults_from_s = 0;   // before it: warm-up, nothing is broken
  double faults_until_s = 0;  // after it: healing, everything is whole again
  double end_s = 0;
};

// Every living vehicle drives again within this, when nothing is broken any more.
inline constexpr double kHealWithin_s = 5;

// Discovery is through after a few seconds, and lasts longer with more vehicles; healing must show
// a vehicle that restarted last, and its slowest right of way.
inline SoakPhases PhasesOf(double duration_s, std::size_t vehicles) {
  const double warm_up_s = std::min(duration_s / 4, 10 + 0.5 * static_cast<double>(vehicles));
  const double heal_s = std::min(duration_s / 4, 20.0);
  return {warm_up_s, duration_s - heal_s, duration_s};
}

}  // namespace giveway::fleetctl

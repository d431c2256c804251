// The times of a soak, from its duration and its fleet. Pure.
#pragma once

#include <algorithm>
#include <cstddef>

#include "services/types/time.h"

namespace giveway::fleetctl {

// A fleet takes ten to start.
inline constexpr double kLeastSoak_s = 30;

// Seconds since the start signal.
struct SoakPhases {
  double faults_from_s = 0;   // before it: warm-up without faults
  double faults_until_s = 0;  // after it: healing without faults
  double end_s = 0;
};

// Every live vehicle drives again within this time after the last fault.
inline constexpr double kHealWithin_s = 5;

// Discovery takes a few seconds, and longer with more vehicles; healing must cover the vehicle that
// restarted last, and its slowest right of way.
inline SoakPhases PhasesOf(double duration_s, std::size_t vehicles) {
  const double warm_up_s = std::min(duration_s / 4, 10 + 0.5 * static_cast<double>(vehicles));
  const double heal_s = std::min(duration_s / 4, 20.0);
  return {warm_up_s, duration_s - heal_s, duration_s};
}

// Until a soak saves again what it has seen, after a save of that processor time: it holds every
// fault so far, so that each save costs more than the one before, and all of them together take a
// hundredth of one core at most.
inline Nanoseconds UntilNextSave(Nanoseconds cost) {
  return std::max<Nanoseconds>(std::chrono::seconds(10), 100 * cost);
}

}  // namespace giveway::fleetctl

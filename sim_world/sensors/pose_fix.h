// A sensor that reports its vehicle's pose, as a landmark system or ultra-wideband radio does:
// periodically, with independent Gaussian errors, and sometimes not at all. One body, one tick;
// random numbers depend on seed, vehicle and tick alone.
#pragma once

#include <cstdint>
#include <optional>

#include "services/types/pose_sensing.h"

namespace giveway::sim {

struct PoseFixMoment {
  std::uint32_t seed = 0;  // the scenario's
  VehicleId vehicle = kNoVehicle;
  std::uint32_t driven_tick = 0;  // since the start signal, from 1
  double dt_s = 0;
  Pose world_from_body;  // the truth at the end of the tick
};

// Pose and deviations; the caller adds vehicle and time. Vehicles take turns: not all of a fleet
// have their fixes in the same tick.
std::optional<PoseFix> SensePose(const PoseFixModel& model, const PoseFixMoment& moment);

}  // namespace giveway::sim

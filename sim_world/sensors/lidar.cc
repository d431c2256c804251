// Single-line lidar: one exact ray a beam, the first surface in range answers.
#include <array>

#include "services/types/math/math.h"
#include "sim_world/sensors/ray_fan.h"
#include "sim_world/sensors/sensor.h"

namespace giveway::sim {

LidarScan SenseLidar(const SensorView& view) {
  static const RayFan fan(-kPi / 2, kPi / (kLidarBeams - 1), kLidarBeams);
  std::array<RayHit, kLidarBeams> hits;
  fan.Cast(view, kLidarRange_m, hits);
  LidarScan scan{.vehicle = view.vehicle, .epoch = view.epoch, .tick = view.tick};
  for (std::size_t i = 0; i < kLidarBeams; ++i) {
    scan.echo[i] = hits[i].hit ? Echo::kEcho : Echo::kClear;
    scan.range_m[i] = hits[i].range_m;
  }
  return scan;
}

}  // namespace giveway::sim

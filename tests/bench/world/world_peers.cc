#include "tests/bench/world/world_peers.h"

#include "services/types/check.h"
#include "services/types/math/math.h"

namespace giveway::bench {

RayFan FanOf(const RobotModel& profile) {
  constexpr double kMiddleRay = (kRaysACone - 1) / 2.0;
  GIVEWAY_CHECK(profile.sonar_half_angle_rad > kMiddleRay * kRayStep_rad - 1e-9 &&
                    profile.sonar_half_angle_rad < kMiddleRay * kRayStep_rad + 1e-9,
                profile.sonar_half_angle_rad);
  RayFan fan;
  fan.range_m = static_cast<float>(profile.sonar_max_range_m);
  for (std::size_t ray = 0; ray < kRaysAVehicle; ++ray) {
    const SensorMount& mount = profile.sonar[ray / kRaysACone];
    GIVEWAY_CHECK(mount.enabled, ray);
    const double off_axis = static_cast<double>(ray % kRaysACone) - kMiddleRay;
    const double bearing_rad = mount.bearing_rad + off_axis * kRayStep_rad;
    fan.origin_x_body[ray] = static_cast<float>(mount.position_body.x);
    fan.origin_y_body[ray] = static_cast<float>(mount.position_body.y);
    fan.direction_x_body[ray] = static_cast<float>(Cos(bearing_rad));
    fan.direction_y_body[ray] = static_cast<float>(Sin(bearing_rad));
  }
  return fan;
}

}  // namespace giveway::bench

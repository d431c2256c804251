#include "services/vehicle/estimation/cones.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway {
namespace {

Cone ConeOf(double bearing_rad, double half_angle_rad) {
  const double nearest_rad = bearing_rad > half_angle_rad    ? bearing_rad - half_angle_rad
                             : bearing_rad < -half_angle_rad ? bearing_rad + half_angle_rad
                                                             : 0;
  return {.axis_body = {Cos(bearing_rad), Sin(bearing_rad)},
          .nearest_body = {Cos(nearest_rad), Sin(nearest_rad)},
          .nearest_cosine = Cos(std::max(0.0, Magnitude(bearing_rad) - half_angle_rad)),
          .bearing_rad = bearing_rad};
}

}  // namespace

Cones ConesOf(const RobotModel& profile) {
  Cones cones{};
  cones.half_sine = Sin(std::min(profile.sonar_half_angle_rad, kPi / 2));
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    cones.of[i] = ConeOf(profile.sonar[i].bearing_rad, profile.sonar_half_angle_rad);
    cones.enabled |= (profile.sonar[i].enabled ? 1U : 0U) << i;
  }
  return cones;
}

}  // namespace giveway

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

// Up to which angle from straight ahead to that side (1 left, -1 right) cones leave no gap.
double CoveredTo(const RobotModel& profile, int side) {
  double to_rad = 0;
  for (bool grows = true; grows;) {
    grows = false;
    for (const SensorMount& mount : profile.sonar) {
      const double middle_rad = side * mount.bearing_rad;
      const double half_rad = profile.sonar_half_angle_rad;
      if (!mount.enabled || middle_rad - half_rad > to_rad || middle_rad + half_rad <= to_rad)
        continue;
      to_rad = middle_rad + half_rad;
      grows = true;
    }
  }
  return std::min(to_rad, kPi / 2);
}

// True if on that side another enabled cone starts where this one ends, or before.
bool AdjoinsAnother(std::size_t sensor, int side, const RobotModel& profile) {
  const double ends_rad = side * profile.sonar[sensor].bearing_rad + profile.sonar_half_angle_rad;
  return std::ranges::any_of(profile.sonar, [&](const SensorMount& other) {
    const double middle_rad = side * other.bearing_rad;
    const double half_rad = profile.sonar_half_angle_rad;
    return other.enabled && middle_rad - half_rad <= ends_rad && middle_rad + half_rad > ends_rad;
  });
}

}  // namespace

Cones ConesOf(const RobotModel& profile) {
  Cones cones{};
  cones.half_sine = Sin(std::min(profile.sonar_half_angle_rad, kPi / 2));
  const double ahead_rad = std::min(CoveredTo(profile, 1), CoveredTo(profile, -1));
  cones.ahead_sine = Sin(ahead_rad);
  cones.ahead_cosine = Cos(ahead_rad);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    cones.of[i] = ConeOf(profile.sonar[i].bearing_rad, profile.sonar_half_angle_rad);
    cones.enabled |= (profile.sonar[i].enabled ? 1U : 0U) << i;
    const bool amid = AdjoinsAnother(i, 1, profile) && AdjoinsAnother(i, -1, profile);
    cones.amid |= (amid ? 1U : 0U) << i;
  }
  cones.amid &= cones.enabled;
  return cones;
}

}  // namespace giveway

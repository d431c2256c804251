#include "services/vehicle/estimation/lost_ticks.h"

#include "services/types/math/math.h"
#include "services/vehicle/estimation/scan_check.h"

namespace giveway {
namespace {

// Of the way: turns to and fro that leave no trace in what was counted.
constexpr double kUnseenTurns = 0.02;

}  // namespace

WayGone WayOfLostTicks(const WheelAngles& before, const RangeScan& scan,
                       const VehicleOptions& options, double dt_s) {
  const VehicleProfile& profile = options.profile;
  const WheelSpeeds mean = {(scan.counted.left_rad - before.left_rad) / dt_s,
                            (scan.counted.right_rad - before.right_rad) / dt_s};
  const Twist twist = TwistFromWheels(profile.drive, mean);
  if (!CanBeDriven(twist, profile)) {
    return {scan.wheels, profile.acceleration_m_s2 * dt_s * dt_s};
  }
  // Whether it turned first or last moves the end across the way by up to half of the angle's arc.
  const double way_m = Magnitude(twist.forward_m_s) * dt_s;
  return {mean, way_m * (Magnitude(twist.turn_rad_s) * dt_s / 2 + kUnseenTurns)};
}

}  // namespace giveway

#include "services/vehicle/estimation/lost_ticks.h"

#include "services/types/math/math.h"
#include "services/vehicle/estimation/scan_check.h"

namespace giveway {
namespace {

// As a share of the displacement: turns to and fro that cancel out in the encoder counts.
constexpr double kUnseenTurns = 0.02;

}  // namespace

LostTicksMotion MotionOfLostTicks(const WheelAngles& before, const RangeScan& scan,
                                  const VehicleOptions& options, double dt_s) {
  const RobotModel& profile = options.profile;
  const WheelSpeeds mean = {(scan.counted.left_rad - before.left_rad) / dt_s,
                            (scan.counted.right_rad - before.right_rad) / dt_s};
  const Twist twist = TwistFromWheels(profile.drive, mean);
  if (!CanBeDriven(twist, profile)) {
    return {scan.wheels, profile.acceleration_m_s2 * dt_s * dt_s};
  }
  // The order of turning and driving moves the end sideways by up to half of the angle's arc.
  const double path_m = Magnitude(twist.forward_m_s) * dt_s;
  return {mean, path_m * (Magnitude(twist.turn_rad_s) * dt_s / 2 + kUnseenTurns)};
}

}  // namespace giveway

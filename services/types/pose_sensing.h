// What a vehicle's pose estimate rests on besides its encoders: a sensor that says where it is, as
// landmarks or ultra-wideband radio do, and by how much its wheels differ from what its drive says.
// Plain values; sim_world/sensors/pose_fix.h makes fixes, vehicle/estimation/pose_keeping.h uses
// them.
#pragma once

#include "services/types/ids.h"
#include "services/types/math/pose.h"

namespace giveway {

// The limit of a vehicle of which more is said than that its wheels slip: how unsure of its
// position it may be, as a standard deviation. Others keep two of them from where it says it is.
inline constexpr double kUsualPoseLimit_m = 0.3;

// The sensor: every so often a fix whose errors are independent of each other.
struct PoseFixModel {
  double every_s = 0;            // 0: not fitted
  double sigma_m = 0;            // of the position, along any axis
  double sigma_heading_rad = 0;  // 0: it says nothing of the heading
  double dropout = 0;            // probability that a fix does not come, [0, 1)

  bool Fitted() const { return every_s > 0; }
};

// Systematic errors of a differential drive, as shares, after Borenstein and Feng, "Measurement and
// Correction of Systematic Odometry Errors in Mobile Robots", IEEE Trans. Robotics and Automation
// 12(6), 1996 (UMBmark): E_d = 1 + diameter, E_b = 1 + axle. The mean diameter is the nominal one.
struct WheelErrors {
  double diameter = 0;  // how much larger the right wheel is than the left
  double axle = 0;      // how much longer the axle is than the drive says

  bool Any() const { return diameter != 0 || axle != 0; }
};

// Either of them is no more than this: more is no wheel any more.
inline constexpr double kMostWheelError = 0.3;

// The speeds at which wheels of the nominal drive would move the body as those of the erring one do
// that turn at `wheels`.
inline WheelSpeeds AsNominal(const DriveGeometry& drive, const WheelErrors& errors,
                             WheelSpeeds wheels) {
  Twist twist = TwistFromWheels(drive, {wheels.left_rad_s * (1 - errors.diameter / 2),
                                        wheels.right_rad_s * (1 + errors.diameter / 2)});
  twist.turn_rad_s /= 1 + errors.axle;
  return WheelsFromTwist(drive, twist);
}

// A fix has a standard deviation of its position of no less than this and no more than that: beyond
// either its square is no use to a filter.
inline constexpr double kLeastFixSigma_m = 1e-6;
inline constexpr double kMostFixSigma_m = 1000;
// The same of its heading, where it has one.
inline constexpr double kLeastFixSigma_rad = 1e-6;

// An external measurement of this vehicle's pose at `tick`: a landmark passed, a camera on the
// ceiling. Deviations are standard deviations; the position's is along any axis.
struct PoseFix {
  Pose world_from_body;  // the heading means nothing where it has no deviation
  double sigma_position_m = 0;
  double sigma_heading_rad = 0;  // 0: the fix says nothing of the heading
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
};

}  // namespace giveway

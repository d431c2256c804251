// What a vehicle is made of: body, drive and ultrasonic ring. The numbers are those of the Pioneer
// P3-DX; other vehicles are other values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/types/math/pose.h"
#include "services/types/pose_sensing.h"

namespace giveway {

inline constexpr std::size_t kSensorCount = 16;

// One ultrasonic transducer, fixed to the body.
struct SensorMount {
  Vec2 position_body;      // m
  double bearing_rad = 0;  // of the cone's axis, counter-clockwise from the body's x axis
  bool enabled = false;    // fitted but switched off gives "no data"
};

enum class BodyShape : std::uint8_t { kDisc, kBox };

// P3-DX values: wheel and axle as in common simulator models, body as ARIA's robot radius, caps and
// accelerations as in the p3dx simulation profile, sonar ring in ARIA's geometry.
struct RobotModel {
  DriveGeometry drive;
  BodyShape shape = BodyShape::kDisc;
  // The disc round the axle centre that holds the body: the body itself, or the half diagonal of a
  // box. Brains and beacons know only this.
  double body_radius_m = 0.25;
  Vec2 box_half_m;             // half length and half width of a box centred on the axle
  double max_speed_m_s = 1.0;  // forward and backward
  double max_turn_rad_s = 1.74;
  double acceleration_m_s2 = 0.3;  // of each wheel's rim, away from standstill
  double deceleration_m_s2 = 0.6;  // of each wheel's rim, towards standstill
  // What the wheels do is not what the encoders say. Standard deviations relative to the speed,
  // drawn again each tick: the ground's share (slip) and the encoder's (noise).
  double wheel_slip = 0;
  double encoder_noise = 0;
  double sonar_half_angle_rad = 0.2617993877991494;  // 30 degree cones
  double sonar_max_range_m = 5.0;                    // beyond it nothing echoes
  // Index 0 is the left side of the front ring, clockwise to 7 on the right side, then 8 at the
  // rear right, clockwise to 15 at the rear left.
  std::array<SensorMount, kSensorCount> sonar{};
  // Further sensors (sensor_scan.h), fitted at the axle centre looking forward; off by default.
  bool radar = false;
  bool lidar = false;
  bool camera = false;
  PoseFixModel pose_fix;
  // The brain uses only the magnitude of these errors, never their sign.
  WheelErrors wheel_error;
  // The standard deviation of its position beyond which it halts and says that it is lost; 0:
  // never.
  double pose_limit_m = 0;
};

// The P3-DX: front eight enabled, rear eight fitted and switched off.
RobotModel PioneerP3dx();

}  // namespace giveway

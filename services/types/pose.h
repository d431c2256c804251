// Where a body is and how it moves. Frames: world (x east, y north, heading counter-clockwise from
// x) and body (x forward, y left, origin at the axle centre).
#pragma once

#include "services/types/vec2.h"

namespace giveway {

// world_from_body. heading_rad in (-pi, pi].
struct Pose {
  Vec2 position_world;
  double heading_rad = 0;

  friend constexpr bool operator==(const Pose&, const Pose&) = default;
};

// Forward speed (m/s, negative backwards) and turn rate (rad/s, counter-clockwise) of a body.
struct Twist {
  double forward_m_s = 0;
  double turn_rad_s = 0;
};

// Wheel rates in rad/s, positive rolls forward.
struct WheelSpeeds {
  double left_rad_s = 0;
  double right_rad_s = 0;

  friend constexpr bool operator==(const WheelSpeeds&, const WheelSpeeds&) = default;
};

// Wheel geometry of a differential drive, metres.
struct DriveGeometry {
  double wheel_radius_m = 0.0975;
  double axle_m = 0.33;
};

// v = r/2 (right + left), w = r/axle (right - left).
inline Twist TwistFromWheels(const DriveGeometry& drive, WheelSpeeds wheels) {
  return {drive.wheel_radius_m / 2 * (wheels.right_rad_s + wheels.left_rad_s),
          drive.wheel_radius_m / drive.axle_m * (wheels.right_rad_s - wheels.left_rad_s)};
}
// The inverse of TwistFromWheels.
inline WheelSpeeds WheelsFromTwist(const DriveGeometry& drive, Twist twist) {
  const double rim = twist.turn_rad_s * drive.axle_m / 2;
  return {(twist.forward_m_s - rim) / drive.wheel_radius_m,
          (twist.forward_m_s + rim) / drive.wheel_radius_m};
}

// The unit vector of the pose's heading in the world.
inline Vec2 Forward(const Pose& world_from_body) {
  const SineCosine heading = SinCos(world_from_body.heading_rad);
  return {heading.cosine, heading.sine};
}

// A point given in the body frame, in the world.
Vec2 ToWorld(const Pose& world_from_body, Vec2 point_body);
// A point given in the world, in the body frame.
Vec2 ToBody(const Pose& world_from_body, Vec2 point_world);

// Exact motion along the arc of a constant twist for dt_s seconds (straight-line limit guarded).
Pose AdvanceArc(const Pose& world_from_body, Twist twist, double dt_s);

}  // namespace giveway

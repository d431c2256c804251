// Where a body is and how it moves. Frames: world (x east, y north, heading counter-clockwise from
// x) and body (x forward, y left, origin at the axle centre).
#pragma once

#include <bit>
#include <cstdint>

#include "services/types/math/vec2.h"

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

// How far wheels have rolled in all, rad, positive forward.
struct WheelAngles {
  double left_rad = 0;
  double right_rad = 0;

  friend constexpr bool operator==(const WheelAngles&, const WheelAngles&) = default;
};

inline WheelAngles CountOn(const WheelAngles& from, WheelSpeeds wheels, double dt_s) {
  return {from.left_rad + dt_s * wheels.left_rad_s, from.right_rad + dt_s * wheels.right_rad_s};
}

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

// How sure a pose is: the covariance of its x, y and heading, world frame, by the upper triangle.
struct PoseCovariance {
  double xx_m2 = 0;
  double xy_m2 = 0;
  double yy_m2 = 0;
  double xh_m_rad = 0;
  double yh_m_rad = 0;
  double hh_rad2 = 0;

  friend constexpr bool operator==(const PoseCovariance&, const PoseCovariance&) = default;
};

// Of the difference of two poses whose errors have nothing to do with each other, and of the sum.
constexpr PoseCovariance operator+(const PoseCovariance& a, const PoseCovariance& b) {
  return {a.xx_m2 + b.xx_m2,       a.xy_m2 + b.xy_m2,       a.yy_m2 + b.yy_m2,
          a.xh_m_rad + b.xh_m_rad, a.yh_m_rad + b.yh_m_rad, a.hh_rad2 + b.hh_rad2};
}

// Of a pose that has since been carried on by a displacement, along a heading as uncertain as it
// says. F C F' with F = [1 0 -d.y; 0 1 d.x; 0 0 1] and d the displacement.
constexpr PoseCovariance Carried(const PoseCovariance& c, Vec2 displacement) {
  const double xh = c.xh_m_rad - displacement.y * c.hh_rad2;
  const double yh = c.yh_m_rad + displacement.x * c.hh_rad2;
  return {.xx_m2 = c.xx_m2 - displacement.y * (c.xh_m_rad + xh),
          .xy_m2 = c.xy_m2 + displacement.x * c.xh_m_rad - displacement.y * yh,
          .yy_m2 = c.yy_m2 + displacement.x * (c.yh_m_rad + yh),
          .xh_m_rad = xh,
          .yh_m_rad = yh,
          .hh_rad2 = c.hh_rad2};
}

// Standard deviations: of the position along its worst axis, and along a unit vector of the world;
// of the heading. 0 where rounding or a wrong sender left no square of anything.
double SigmaPosition(const PoseCovariance& covariance);
double SigmaAlong(const PoseCovariance& covariance, Vec2 direction_world);
double SigmaHeading(const PoseCovariance& covariance);

// The unit vector of the pose's heading in the world.
inline Vec2 Forward(const Pose& world_from_body) {
  const SineCosine heading = SinCos(world_from_body.heading_rad);
  return {heading.cosine, heading.sine};
}

// A heading and its unit vector. Cached: sin and cos are expensive, and the heading is unchanged
// while the vehicle is stationary or drives straight.
struct CachedHeading {
  double heading_rad = 0;
  Vec2 forward_world{1, 0};

  // By its bits: of -0 and 0 the unit vectors are not the same either.
  void Follow(const Pose& world_from_body) {
    if (std::bit_cast<std::uint64_t>(world_from_body.heading_rad) !=
        std::bit_cast<std::uint64_t>(heading_rad)) {
      *this = {world_from_body.heading_rad, Forward(world_from_body)};
    }
  }
};

// The heading along a direction. Cached: an arctangent is even more expensive, and the direction is
// unchanged while the vehicle is stationary.
struct CachedBearing {
  Vec2 direction_world{1, 0};
  double heading_rad = 0;

  double Of(Vec2 direction) {
    if (!(direction == direction_world)) *this = {direction, Atan2(direction.y, direction.x)};
    return heading_rad;
  }
};

// A point given in the body frame, in the world.
Vec2 ToWorld(const Pose& world_from_body, Vec2 point_body);
// A point given in the world, in the body frame.
Vec2 ToBody(const Pose& world_from_body, Vec2 point_world);

// Exact motion along the arc of a constant twist for dt_s seconds (straight-line limit guarded).
Pose AdvanceArc(const Pose& world_from_body, Twist twist, double dt_s);
// The same bits, straight on without a sine: forward_world is the unit vector of the heading.
Pose AdvanceArc(const Pose& world_from_body, Vec2 forward_world, Twist twist, double dt_s);

// A pose by the unit vector of its heading: the angle of a peer itself is never needed.
struct Facing {
  Vec2 position_world;
  Vec2 forward_world;
};
// The same motion, which takes no sine at all straight on.
Facing AdvanceFacing(const Facing& from, Twist twist, double dt_s);

}  // namespace giveway

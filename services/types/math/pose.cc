#include "services/types/math/pose.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway {

Vec2 ToWorld(const Pose& world_from_body, Vec2 point_body) {
  const Vec2 x_axis = Forward(world_from_body);
  return world_from_body.position_world + point_body.x * x_axis + point_body.y * Left(x_axis);
}

Vec2 ToBody(const Pose& world_from_body, Vec2 point_world) {
  const Vec2 x_axis = Forward(world_from_body);
  const Vec2 offset_world = point_world - world_from_body.position_world;
  return {Dot(x_axis, offset_world), Cross(x_axis, offset_world)};
}

Pose AdvanceArc(const Pose& world_from_body, Twist twist, double dt_s) {
  if (twist.forward_m_s == 0 && twist.turn_rad_s == 0) return world_from_body;
  const double turned = twist.turn_rad_s * dt_s;
  const double half = turned / 2;
  // The chord of an arc of length v dt and angle `turned` is v dt sin(half)/half long and points
  // along the heading in the middle. Below 1e-4 the series is exact to the last bit.
  const double sinc = half < 1e-4 && half > -1e-4 ? 1 - half * half / 6 : Sin(half) / half;
  const double chord = twist.forward_m_s * dt_s * sinc;
  const SineCosine middle = SinCos(world_from_body.heading_rad + half);
  return {world_from_body.position_world + chord * Vec2{middle.cosine, middle.sine},
          WrapAngle(world_from_body.heading_rad + turned)};
}

Pose AdvanceArc(const Pose& world_from_body, Vec2 forward_world, Twist twist, double dt_s) {
  if (twist.turn_rad_s != 0 || twist.forward_m_s == 0) {
    return AdvanceArc(world_from_body, twist, dt_s);
  }
  // The turn is none, and added all the same: of a heading of -0 it makes 0, as the arc does.
  return {world_from_body.position_world + twist.forward_m_s * dt_s * forward_world,
          WrapAngle(world_from_body.heading_rad + twist.turn_rad_s * dt_s)};
}

Facing AdvanceFacing(const Facing& from, Twist twist, double dt_s) {
  const double half = twist.turn_rad_s * dt_s / 2;
  double chord = twist.forward_m_s * dt_s;
  Vec2 middle = from.forward_world;
  Vec2 end = from.forward_world;
  if (half != 0) {
    const SineCosine turn = SinCos(half);
    if (half > 1e-4 || half < -1e-4) chord *= turn.sine / half;
    const auto turned = [turn](Vec2 a) { return turn.cosine * a + turn.sine * Left(a); };
    middle = turned(from.forward_world);
    end = turned(middle);
  }
  return {from.position_world + chord * middle, end};
}

double SigmaPosition(const PoseCovariance& c) {
  if (c.xx_m2 + c.yy_m2 <= 0) return 0;  // an exact pose: saves two square roots
  const double mean = (c.xx_m2 + c.yy_m2) / 2;
  const double half = (c.xx_m2 - c.yy_m2) / 2;
  const double spread = Sqrt(half * half + c.xy_m2 * c.xy_m2);
  return Sqrt(std::max(0.0, mean + spread));  // the larger eigenvalue
}

double SigmaAlong(const PoseCovariance& c, Vec2 d) {
  return Sqrt(std::max(0.0, d.x * d.x * c.xx_m2 + 2 * d.x * d.y * c.xy_m2 + d.y * d.y * c.yy_m2));
}

double SigmaHeading(const PoseCovariance& c) { return Sqrt(std::max(0.0, c.hh_rad2)); }

}  // namespace giveway

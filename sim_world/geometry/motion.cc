#include "sim_world/geometry/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::sim {

Motion StandingAt(const RobotModel& profile, const Pose& world_from_body) {
  const bool box = profile.shape == BodyShape::kBox;
  return {.start_world = world_from_body,
          .radius_m = box ? Norm(profile.box_half_m) : profile.body_radius_m,
          .box_half_m = box ? profile.box_half_m : Vec2{}};
}

Pose PoseAt(const Motion& motion, double t_s) {
  const double moved_s = std::min(t_s, motion.stop_s);
  if (motion.slide_world == Vec2{}) return AdvanceArc(motion.start_world, motion.twist, moved_s);
  return {motion.start_world.position_world + moved_s * motion.slide_world,
          motion.start_world.heading_rad};
}

Vec2 PositionAt(const Motion& motion, double t_s) { return PoseAt(motion, t_s).position_world; }

Vec2 TipAt(const Leaf& leaf, double t_s) {
  return leaf.to_world + std::min(t_s, leaf.stop_s) * leaf.to_velocity_world;
}

Outline OutlineAt(const Motion& motion, double t_s) {
  const Pose pose = PoseAt(motion, t_s);
  const Vec2 x_axis = Forward(pose);
  Vec2 velocity;
  double turn = 0;
  if (t_s <= motion.stop_s) {
    velocity = motion.twist.forward_m_s * x_axis + motion.slide_world;
    turn = motion.twist.turn_rad_s;
  }
  Outline outline;
  if (!motion.IsBox()) {
    outline.corner_world[0] = pose.position_world;
    outline.velocity_world[0] = velocity;
    outline.radius_m = motion.radius_m;
    return outline;
  }
  const Vec2 length = motion.box_half_m.x * x_axis;
  const Vec2 width = motion.box_half_m.y * Left(x_axis);
  outline.count = 4;
  const std::array<Vec2, 4> offsets = {length - width, length + width, width - length,
                                       -1 * (length + width)};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    outline.corner_world[i] = pose.position_world + offsets[i];
    outline.velocity_world[i] = velocity + turn * Left(offsets[i]);
  }
  return outline;
}

Outline OutlineAt(const Leaf& leaf, double t_s) {
  Outline outline = {.corner_world = {leaf.from_world, TipAt(leaf, t_s)}, .count = 2};
  if (t_s <= leaf.stop_s) outline.velocity_world[1] = leaf.to_velocity_world;
  return outline;
}

Outline OutlineOf(const Wall& wall) {
  return {.corner_world = {wall.from_world, wall.to_world}, .count = 2};
}

bool Moves(const Motion& motion) {
  return motion.twist.forward_m_s != 0 || motion.slide_world != Vec2{} ||
         (motion.IsBox() && motion.twist.turn_rad_s != 0);
}

bool Moves(const Leaf& leaf) { return leaf.to_velocity_world != Vec2{}; }

double TravelBound(const Motion& motion, double dt_s) {
  if (motion.slide_world == Vec2{}) return std::abs(motion.twist.forward_m_s) * dt_s;
  return Norm(motion.slide_world) * dt_s;
}

double TravelBound(const Leaf& leaf, double dt_s) {
  return Moves(leaf) ? Norm(leaf.to_velocity_world) * dt_s : 0;
}

double GapAt(const Motion& a, const Motion& b, double t_s) {
  if (BothAreDiscs(a, b)) {
    return Norm(PositionAt(a, t_s) - PositionAt(b, t_s)) - a.radius_m - b.radius_m;
  }
  return NearestBetween(OutlineAt(a, t_s), OutlineAt(b, t_s)).gap_m;
}

double GapAt(const Motion& a, const Leaf& leaf, double t_s) {
  return GapAt(a, Wall{leaf.from_world, TipAt(leaf, t_s)}, t_s);
}

double GapAt(const Motion& a, const Wall& wall, double t_s) {
  if (a.IsBox()) return NearestBetween(OutlineAt(a, t_s), OutlineOf(wall)).gap_m;
  const Vec2 centre = PositionAt(a, t_s);
  return Norm(centre - NearestOnSegment(wall.from_world, wall.to_world, centre)) - a.radius_m;
}

}  // namespace giveway::sim

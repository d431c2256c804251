// The plane geometry of start poses: do discs, boxes and segments share a point? Exact, and
// touching counts. False where a number is not finite. The world has geometry of its own; this
// module does not see it.
#pragma once

#include "services/types/math/pose.h"
#include "services/types/robot_model.h"

namespace giveway {

// The ground a body covers.
struct StartShape {
  BodyShape shape = BodyShape::kDisc;
  Pose world_from_body;
  double radius_m = 0;  // of a disc
  Vec2 box_half_m;      // of a box
};

struct StartLine {
  Vec2 from_world;
  Vec2 to_world;
};

// A rectangle along the axes of the world that just holds the shape. NaN in, NaN out.
struct Bounds {
  Vec2 low_world;
  Vec2 high_world;
};
Bounds BoundsOf(const StartShape& shape);
Bounds BoundsOf(const StartLine& line);

bool Overlap(const StartShape& a, const StartShape& b);
bool Overlap(const StartShape& shape, const StartLine& line);
// True if each goes through the other's inside: neither touching ends nor lying along each other.
bool Cross(const StartLine& a, const StartLine& b);
double DistanceToLine(Vec2 point_world, const StartLine& line);

}  // namespace giveway

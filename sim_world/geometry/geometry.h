// Plane geometry that both the ultrasonics and the contacts need.
#pragma once

#include <algorithm>

#include "services/types/math/vec2.h"

namespace giveway::sim {

// Where on the segment from + u * (to - from), u in [0, 1], the point nearest to `point` lies.
// A segment without length is a point.
inline double NearestParameter(Vec2 from, Vec2 to, Vec2 point) {
  const Vec2 along = to - from;
  const double squared_length = SquaredNorm(along);
  if (squared_length <= 0) return 0;
  return std::clamp(Dot(point - from, along) / squared_length, 0.0, 1.0);
}

inline Vec2 NearestOnSegment(Vec2 from, Vec2 to, Vec2 point) {
  return from + NearestParameter(from, to, point) * (to - from);
}

}  // namespace giveway::sim

// Convex shapes with round corners at one moment: disc (one corner), segment (two) or box (four),
// and the gap between two of them. Knows no motion beyond the corners' velocities.
#pragma once

#include <array>
#include <cstdint>

#include "services/types/math/vec2.h"

namespace giveway::sim {

struct Outline {
  std::array<Vec2, 4> corner_world{};    // counter-clockwise
  std::array<Vec2, 4> velocity_world{};  // of each corner, m/s
  std::uint32_t count = 1;
  double radius_m = 0;  // the shell is this far round the corners' hull
};

// The axis along which two outlines are nearest.
struct Nearest {
  double gap_m = 0;  // shell to shell; negative where they overlap
  Vec2 axis_world;   // unit vector from a to b
  Vec2 on_b_world;   // the point of b's shell that is nearest to a
};

Nearest NearestBetween(const Outline& a, const Outline& b);

// How fast the gap opens, m/s; negative: closes. Where flat sides lie along each other, of the
// place that closes fastest.
double GapRate(const Outline& a, const Outline& b, const Nearest& nearest);

}  // namespace giveway::sim

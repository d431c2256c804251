// A plain 2-D vector. Not Eigen's: brain and world state must be trivially copyable, and Eigen's
// fixed-size vectors are not. Eigen comes in where there is linear algebra to do.
#pragma once

#include "services/types/math/math.h"

namespace giveway {

// Metres (or a direction without unit) in the frame the variable's name ends in.
struct Vec2 {
  double x = 0;
  double y = 0;

  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator*(double k, Vec2 a) { return {k * a.x, k * a.y}; }
constexpr double Dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
// The z component of the 3-D cross product: positive where b lies counter-clockwise of a.
constexpr double Cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
// `a` turned a quarter counter-clockwise.
constexpr Vec2 Left(Vec2 a) { return {-a.y, a.x}; }
constexpr double SquaredNorm(Vec2 a) { return Dot(a, a); }
inline double Norm(Vec2 a) { return Sqrt(SquaredNorm(a)); }

}  // namespace giveway

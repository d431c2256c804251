// Elementary functions that give the same bits on every machine: only + - * / and sqrt, which
// IEEE 754 rounds exactly. The C library picks another kernel per CPU, so it is not used here.
// Absolute error below 1e-12 for |x| up to 1e5 (tests/unit/types/math_test.cc measures it).
#pragma once

#include <cmath>

namespace giveway {

inline constexpr double kPi = 3.14159265358979323846;

inline double Magnitude(double x) { return std::abs(x); }  // one instruction, unlike a comparison
inline double Sqrt(double x) { return std::sqrt(x); }      // correctly rounded by IEEE 754
// No number for what is no angle, or lies beyond 2^30 quarter turns.
double Sin(double x_rad);
double Cos(double x_rad);
struct SineCosine {
  double sine = 0;
  double cosine = 1;
};
// The same bits as Sin and Cos, for little more than the price of one: for headings.
SineCosine SinCos(double x_rad);
// The angle of (x, y) in (-pi, pi]; Atan2(0, 0) is 0.
double Atan2(double y, double x);
// Natural logarithm; x must be positive and finite.
double Log(double x);
double Exp(double x);

// For whatever is not in (-3.14, 3.14) already; see WrapAngle.
double WrapFarAngle(double angle_rad);
// The same angle in (-pi, pi].
inline double WrapAngle(double angle_rad) {
  return angle_rad > -3.14 && angle_rad < 3.14 ? angle_rad : WrapFarAngle(angle_rad);
}

constexpr double Radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double Degrees(double radians) { return radians * (180.0 / kPi); }

}  // namespace giveway

#include "services/types/math/math.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace giveway {
namespace {

// pi/2 in three parts of at most 33 significant bits, so that n * part is exact for n < 2^20
// (Cody and Waite 1980).
constexpr double kHalfPi1 = 1.57079632673412561417e+00;
constexpr double kHalfPi2 = 6.07710050630396597660e-11;
constexpr double kHalfPi3 = 2.02226624879595063154e-21;
constexpr double kLn2High = 6.93147180369123816490e-01;
constexpr double kLn2Low = 1.90821492927058770002e-10;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
// Beyond it a double does not resolve a turn well enough.
constexpr double kMostTurns = 0x1p30;

// No number for |x| beyond kMostTurns, and for what is none.
double Nearest(double x) {
  const bool is_near = x > -kMostTurns && x < kMostTurns;
  if (!is_near) return kNoNumber;
  return static_cast<double>(static_cast<std::int64_t>(x + std::copysign(0.5, x)));
}

// The value of c[0] + c[1] x + c[2] x^2 + … by Horner's scheme.
template <std::size_t N>
double Polynomial(const std::array<double, N>& c, double x) {
  double sum = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = c[i] + x * sum;
  return sum;
}

// Taylor coefficients first!/(first + 2 i)! with alternating signs, of sin (first 1) and cos (0).
template <std::size_t N>
constexpr std::array<double, N> AlternatingFactorials(int first) {
  std::array<double, N> c{1.0};
  for (std::size_t i = 1; i < N; ++i) {
    const int k = first + 2 * static_cast<int>(i);
    c[i] = -c[i - 1] / (k * (k - 1));
  }
  return c;
}

// Coefficients 1, s/3, 1/5, s/7 … of atan (s = -1) and artanh (s = 1).
template <std::size_t N>
constexpr std::array<double, N> OddReciprocals(int sign) {
  std::array<double, N> c{};
  for (std::size_t i = 0; i < N; ++i) {
    c[i] = (sign < 0 && i % 2 == 1 ? -1.0 : 1.0) / static_cast<double>(2 * i + 1);
  }
  return c;
}

// On [-pi/4, pi/4] the first term left out is below 1e-19.
double SinNearZero(double r) {
  static constexpr auto kTaylor = AlternatingFactorials<9>(1);
  return r * Polynomial(kTaylor, r * r);
}

double CosNearZero(double r) {
  static constexpr auto kTaylor = AlternatingFactorials<10>(0);
  return Polynomial(kTaylor, r * r);
}

struct Quadrant {
  std::int64_t index;  // of the quarter turn nearest to x
  double rest;         // x minus that many quarter turns, in [-pi/4, pi/4]
};

Quadrant Reduce(double x) {
  const double n = Nearest(x * (2 / kPi));
  const double rest = ((x - n * kHalfPi1) - n * kHalfPi2) - n * kHalfPi3;
  return {std::isnan(n) ? 0 : static_cast<std::int64_t>(n), rest};
}

// atan on [0, 1]: the half-angle formula twice brings z below tan(pi/16), then Taylor.
double AtanUnit(double z) {
  for (int i = 0; i < 2; ++i) z = z / (1 + Sqrt(1 + z * z));
  static constexpr auto kTaylor = OddReciprocals<14>(-1);
  return 4 * z * Polynomial(kTaylor, z * z);
}

}  // namespace

double Sin(double x_rad) {
  const auto [index, rest] = Reduce(x_rad);
  const double magnitude = index % 2 == 0 ? SinNearZero(rest) : CosNearZero(rest);
  return (index & 2) == 0 ? magnitude : -magnitude;
}

double Cos(double x_rad) {
  const auto [index, rest] = Reduce(x_rad);
  const double magnitude = index % 2 == 0 ? CosNearZero(rest) : SinNearZero(rest);
  return ((index + 1) & 2) == 0 ? magnitude : -magnitude;
}

SineCosine SinCos(double x_rad) {
  const auto [index, rest] = Reduce(x_rad);
  const double sine = SinNearZero(rest);
  const double cosine = CosNearZero(rest);
  switch (index & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

double Atan2(double y, double x) {
  const double ax = Magnitude(x);
  const double ay = Magnitude(y);
  if (ax == 0 && ay == 0) return 0;
  double angle = ay <= ax ? AtanUnit(ay / ax) : kPi / 2 - AtanUnit(ax / ay);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

double Log(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  if (exponent == -1023) return Log(x * 0x1p54) - 54 * (kLn2High + kLn2Low);  // subnormal
  double m = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  if (m > 1.41421356237309504880) {
    m *= 0.5;
    ++exponent;
  }
  // log m = 2 artanh s with s = (m - 1) / (m + 1), |s| < 0.172
  const double s = (m - 1) / (m + 1);
  static constexpr auto kTaylor = OddReciprocals<12>(1);
  return exponent * kLn2High + (2 * s * Polynomial(kTaylor, s * s) + exponent * kLn2Low);
}

double Exp(double x) {
  if (x < -700) return 0;
  if (x > 709) return std::numeric_limits<double>::infinity();
  if (std::isnan(x)) return x;
  const double k = Nearest(x / (kLn2High + kLn2Low));
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double sum = 1;
  for (int i = 16; i >= 1; --i) sum = 1 + r / i * sum;
  const auto exponent = static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023);
  return sum * std::bit_cast<double>(exponent << 52);
}

double WrapFarAngle(double angle_rad) {
  double a = angle_rad - Nearest(angle_rad / (2 * kPi)) * (2 * kPi);
  if (a <= -kPi) a += 2 * kPi;
  if (a > kPi) a -= 2 * kPi;
  return a;
}

}  // namespace giveway

#include "services/statistics/distributions.h"

#include "services/types/math/math.h"

namespace giveway::statistics {
namespace {

constexpr double kTailBegins = 3;
constexpr double kTailEnds = 37;  // above it nothing is left that a double holds
constexpr int kFractions = 120;
constexpr double kStirlingBegins = 15;

double NormalDensity(double z) { return Exp(-z * z / 2) / Sqrt(2 * kPi); }

}  // namespace

double NormalAbove(double z) {
  if (z < 0) return 1 - NormalAbove(-z);
  if (z > kTailEnds) return 0;
  if (z < kTailBegins) {
    double term = z;
    double sum = z;
    for (int i = 3; term > sum * 1e-17; i += 2) {
      term *= z * z / i;
      sum += term;
    }
    return 0.5 - NormalDensity(z) * sum;
  }
  double fraction = z;
  for (int i = kFractions; i > 0; --i) fraction = z + i / fraction;
  return NormalDensity(z) / fraction;
}

double LogFactorial(double n) {
  double x = n + 1;
  double below = 1;  // what is divided out again
  while (x < kStirlingBegins) below *= x++;
  const double x3 = x * x * x;
  const double series =
      1 / (12 * x) - 1 / (360 * x3) + 1 / (1260 * x3 * x * x) - 1 / (1680 * x3 * x3 * x);
  return (x - 0.5) * Log(x) - x + Log(2 * kPi) / 2 + series - Log(below);
}

}  // namespace giveway::statistics

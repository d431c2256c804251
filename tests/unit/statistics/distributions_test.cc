#include "services/statistics/distributions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace giveway::statistics {
namespace {

TEST(Distributions, NormalTailIsThatOfTheComplementaryErrorFunction) {
  for (double z = -8; z < 36; z += 0.0625) {
    const double exact = std::erfc(z / std::sqrt(2.0)) / 2;
    EXPECT_NEAR(NormalAbove(z), exact, exact * 1e-9) << z;
  }
  EXPECT_EQ(NormalAbove(1000), 0);
  EXPECT_EQ(NormalAbove(-1000), 1);
}

TEST(Distributions, LogFactorialIsThatOfTheGammaFunction) {
  for (double n = 0; n < 1e7; n = n < 40 ? n + 1 : n * 1.3) {
    const double exact = std::lgamma(n + 1);
    EXPECT_NEAR(LogFactorial(n), exact, 1e-12 * std::max(1.0, exact)) << n;
  }
}

}  // namespace
}  // namespace giveway::statistics

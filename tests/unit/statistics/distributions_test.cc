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

}  // namespace
}  // namespace giveway::statistics

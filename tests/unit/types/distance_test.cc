#include "services/types/math/distance.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>

#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr DistanceMetric kAll[] = {DistanceMetric::kEuclidean, DistanceMetric::kManhattan,
                                   DistanceMetric::kChebyshev};

// The same cases in every run, unless the environment says otherwise.
const bool kSeeded = setenv("RC_PARAMS", "seed=21 max_success=1000", 0) == 0;

// Whole millimetres up to 100 m: sums of two are exact enough to compare.
Vec2 AnyOffset() {
  return {*rc::gen::inRange(-100'000, 100'001) / 1000.0,
          *rc::gen::inRange(-100'000, 100'001) / 1000.0};
}

DistanceMetric AnyMetric() {
  return *rc::gen::elementOf(std::vector(std::begin(kAll), std::end(kAll)));
}

TEST(Distance, IsWhatTheNamesSay) {
  const Vec2 offset{3, -4};
  EXPECT_EQ(Distance(DistanceMetric::kEuclidean, offset), 5);
  EXPECT_EQ(Distance(DistanceMetric::kManhattan, offset), 7);
  EXPECT_EQ(Distance(DistanceMetric::kChebyshev, offset), 4);
}

RC_GTEST_PROP(Distance, ChebyshevIsTheLeastAndManhattanTheMost, ()) {
  const Vec2 offset = AnyOffset();
  const double euclidean = Distance(DistanceMetric::kEuclidean, offset);
  RC_ASSERT(Distance(DistanceMetric::kChebyshev, offset) <= euclidean * (1 + 1e-15));
  RC_ASSERT(euclidean <= Distance(DistanceMetric::kManhattan, offset) * (1 + 1e-15));
}

RC_GTEST_PROP(Distance, IsZeroForTheSamePlaceOnly, ()) {
  const Vec2 offset = AnyOffset();
  RC_ASSERT((Distance(AnyMetric(), offset) == 0) == (offset == Vec2{}));
}

RC_GTEST_PROP(Distance, IsTheSameThereAndBackAndNeverLongerThanByWayOfAThirdPlace, ()) {
  const DistanceMetric metric = AnyMetric();
  const Vec2 a = AnyOffset();
  const Vec2 b = AnyOffset();
  RC_ASSERT(Distance(metric, a) == Distance(metric, -1.0 * a));
  RC_ASSERT(Distance(metric, a + b) <= Distance(metric, a) + Distance(metric, b) + 1e-9);
}

RC_GTEST_PROP(Distance, GrowsInProportion, ()) {
  const DistanceMetric metric = AnyMetric();
  const Vec2 offset = AnyOffset();
  RC_ASSERT(Distance(metric, 2.0 * offset) == 2 * Distance(metric, offset));
}

// The safety of every gate: a vehicle inside it by the Euclidean distance is inside it by any
// metric.
RC_GTEST_PROP(GateDistance, IsNeverAboveTheEuclideanNotEvenByRounding, ()) {
  const Vec2 offset = AnyOffset();
  RC_ASSERT(GateDistance(AnyMetric(), offset) <= Norm(offset));
}

// There the scaled Manhattan distance equals the Euclidean one, except for the last bit.
TEST(GateDistance, IsNotAboveTheEuclideanOnTheDiagonalEither) {
  for (int i = 1; i <= 1000; ++i) {
    const Vec2 offset{i / 1000.0, i / -1000.0};
    ASSERT_LE(GateDistance(DistanceMetric::kManhattan, offset), Norm(offset)) << i;
  }
}

RC_GTEST_PROP(GateDistance, ReachesAtMostSqrtTwoTimesAsFar, ()) {
  const Vec2 offset = AnyOffset();
  RC_ASSERT(GateDistance(AnyMetric(), offset) * Sqrt(2.0) >= Norm(offset) * (1 - 1e-15));
}

TEST(GateDistance, IsTheNormBitForBitByDefault) {
  const Vec2 offset{0.1, 0.7};
  EXPECT_EQ(GateDistance(DistanceMetric{}, offset), Norm(offset));
}

TEST(GateDistance, OfManhattanIsADiamondAndOfChebyshevASquareRoundTheCircle) {
  const Vec2 along{1, 0};
  const Vec2 askew{Sqrt(0.5), Sqrt(0.5)};
  EXPECT_NEAR(GateDistance(DistanceMetric::kManhattan, along), Sqrt(0.5), 1e-15);
  EXPECT_NEAR(GateDistance(DistanceMetric::kManhattan, askew), 1, 1e-15);
  EXPECT_NEAR(GateDistance(DistanceMetric::kChebyshev, along), 1, 1e-15);
  EXPECT_NEAR(GateDistance(DistanceMetric::kChebyshev, askew), Sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace giveway

#include "services/vehicle/estimation/conflict.h"

#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway {
namespace {

Path From(double x, double y, double heading_deg) {
  return {{x, y}, {Cos(Radians(heading_deg)), Sin(Radians(heading_deg))}};
}

//            | peer, from (0, -3) north
//  own ──────+────►   from (-4, 0) east; within 0.7 m of its line from 3.3 m to 4.7 m on
TEST(Conflict, ASquareCrossingIsTheReachOnEitherSide) {
  const auto conflict = FindConflict(From(-4, 0, 0), From(0, -3, 90), 0.7);
  ASSERT_TRUE(conflict);
  EXPECT_NEAR(conflict->own.begin_m, 3.3, 1e-12);
  EXPECT_NEAR(conflict->own.end_m, 4.7, 1e-12);
  EXPECT_NEAR(conflict->peer.begin_m, 2.3, 1e-12);
  EXPECT_NEAR(conflict->peer.end_m, 3.7, 1e-12);
}

TEST(Conflict, AnObliqueCrossingIsLongerByTheSine) {
  const auto conflict = FindConflict(From(-4, 0, 0), From(-4, -4, 45), 0.5);
  ASSERT_TRUE(conflict);
  EXPECT_NEAR(conflict->own.end_m - conflict->own.begin_m, 1.0 / Sin(Radians(45)), 1e-9);
}

TEST(Conflict, APeerThatHasPassedIsNone) {
  EXPECT_TRUE(FindConflict(From(-4, 0, 0), From(0, 0.69, 90), 0.7));
  EXPECT_FALSE(FindConflict(From(-4, 0, 0), From(0, 0.71, 90), 0.7));
}

TEST(Conflict, PathsThatDivergeHaveNone) {
  EXPECT_FALSE(FindConflict(From(-4, 0, 180), From(0, -3, 90), 0.7));
}

TEST(Conflict, LanesSideBySideHaveNoneBeyondTheReach) {
  EXPECT_FALSE(FindConflict(From(-4, 0, 0), From(4, 0.8, 180), 0.7));
  EXPECT_TRUE(FindConflict(From(-4, 0, 0), From(4, 0.6, 180), 0.7));
}

TEST(Conflict, HeadOnReachesFromHereToThere) {
  const auto conflict = FindConflict(From(-2, 0, 0), From(2, 0, 180), 0.7);
  ASSERT_TRUE(conflict);
  EXPECT_LE(conflict->own.begin_m, 0);
  EXPECT_NEAR(conflict->own.end_m, 4.7, 1e-12);
}

// Sampling both paths: a point of one is in the stretch if and only if the other comes within
// reach.
TEST(Conflict, StretchesAgreeWithSampling) {
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const Path own = From(random.Uniform(-4, 4), random.Uniform(-4, 4), random.Uniform(0, 360));
    const Path other = From(random.Uniform(-4, 4), random.Uniform(-4, 4), random.Uniform(0, 360));
    const double s = random.Uniform(-8, 8);
    const Vec2 point = own.from_world + s * own.direction_world;
    double along = Dot(point - other.from_world, other.direction_world);
    along = along < 0 ? 0 : along;
    const double distance = Norm(point - other.from_world - along * other.direction_world);
    if (distance > 0.699999 && distance < 0.700001) continue;  // on the edge to rounding
    const Stretch stretch = StretchNear(own, other, 0.7);
    const bool inside = s >= stretch.begin_m && s <= stretch.end_m;
    ASSERT_EQ(inside, distance <= 0.7) << "placement " << i;
  }
}

TEST(Conflict, HoldsTheStretchOfEitherPathNearTheOther) {
  Random random(6);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Path own = From(random.Uniform(-4, 4), random.Uniform(-4, 4), random.Uniform(0, 360));
    const Path peer = From(random.Uniform(-4, 4), random.Uniform(-4, 4), random.Uniform(0, 360));
    const auto conflict = FindConflict(own, peer, 0.7);
    if (!conflict) continue;
    ++found;
    const Stretch of_own = StretchNear(own, peer, 0.7);
    const Stretch of_peer = StretchNear(peer, own, 0.7);
    ASSERT_EQ(conflict->own.begin_m, of_own.begin_m) << "placement " << i;
    ASSERT_EQ(conflict->own.end_m, of_own.end_m) << "placement " << i;
    ASSERT_EQ(conflict->peer.begin_m, of_peer.begin_m) << "placement " << i;
    ASSERT_EQ(conflict->peer.end_m, of_peer.end_m) << "placement " << i;
  }
  EXPECT_GT(found, 300);
}

TEST(Conflict, TheSpeedToStopWithinIsTheInverseOfTheStoppingDistance) {
  for (double v : {0.05, 0.3, 1.0}) {
    EXPECT_NEAR(SpeedToStopWithin(StoppingDistance(v, 0.1, 0.6), 0.1, 0.6), v, 1e-12);
  }
  EXPECT_EQ(SpeedToStopWithin(-0.1, 0.1, 0.6), 0);
}

// 0.3 m/s^2 up to 0.3 m/s takes 1 s and 0.15 m; then 0.3 m more at cruise takes another second.
TEST(Conflict, TimeToCoverCountsTheAcceleration) {
  EXPECT_NEAR(TimeToCover(0.45, 0, 0.3, 0.3), 2.0, 1e-12);
  EXPECT_NEAR(TimeToCover(0.0375, 0, 0.3, 0.3), 0.5, 1e-12);
  EXPECT_NEAR(TimeToCover(0.3, 0.3, 0.3, 0.3), 1.0, 1e-12);
  EXPECT_EQ(TimeToCover(-1, 0, 0.3, 0.3), 0);
}

}  // namespace
}  // namespace giveway

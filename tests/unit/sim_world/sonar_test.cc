#include "sim_world/sensors/sonar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway::sim {
namespace {

constexpr double kHalfAngle = 15 * kPi / 180;

Cone ConeAt(Vec2 apex, double bearing_rad, double half_rad = kHalfAngle, double max_range_m = 5) {
  return {.apex = apex,
          .axis = {std::cos(bearing_rad), std::sin(bearing_rad)},
          .cos_half = std::cos(half_rad),
          .sin_half = std::sin(half_rad),
          .max_range_m = max_range_m};
}

const Cone kCone = ConeAt({0, 0}, 0);

// The oracle: the nearest of many points sampled on the object, by angle; knows no closed form.
template <typename PointAt>
std::optional<double> Sampled(double bearing_rad, Vec2 apex, double half_rad, int samples,
                              const PointAt& point_at) {
  std::optional<double> nearest;
  for (int i = 0; i <= samples; ++i) {
    const Vec2 offset = point_at(static_cast<double>(i) / samples) - apex;
    const double angle = std::remainder(std::atan2(offset.y, offset.x) - bearing_rad, 2 * kPi);
    const double distance = std::hypot(offset.x, offset.y);
    if (std::abs(angle) > half_rad || distance > 5) continue;
    if (!nearest || distance < *nearest) nearest = distance;
  }
  return nearest;
}

// Compares with the oracle at the cone's own half angle, and, where the two disagree about a hit,
// demands that a cone wider or narrower by `slack_rad` explains it.
template <typename PointAt>
void ExpectAgrees(std::optional<double> exact, double bearing_rad, Vec2 apex, double slack_m,
                  const PointAt& point_at) {
  constexpr int kPoints = 20'000;
  constexpr double kSlack_rad = 1e-3;
  const auto sampled = [&](double half_rad) {
    return Sampled(bearing_rad, apex, half_rad, kPoints, point_at);
  };
  const std::optional<double> oracle = sampled(kHalfAngle);
  if (exact && oracle) {
    ASSERT_LE(*exact, *oracle + 1e-9);
    ASSERT_GE(*exact, *oracle - slack_m);
  } else if (exact && *exact < 5 - slack_m) {
    ASSERT_TRUE(sampled(kHalfAngle + kSlack_rad).has_value()) << *exact;
  } else {
    ASSERT_FALSE(oracle.has_value()) << *oracle;
  }
}

TEST(Sonar, ADiscIsAsNearAsItsNearestPointInTheCone) {
  Random random(21);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec2 apex = {random.Uniform(-1, 1), random.Uniform(-1, 1)};
    const double bearing = random.Uniform(-kPi, kPi);
    const double towards = bearing + random.Uniform(-0.6, 0.6);
    const double radius = random.Uniform(0.05, 0.5);
    const double away = random.Uniform(radius + 0.01, 5.5);
    const Vec2 centre = apex + away * Vec2{std::cos(towards), std::sin(towards)};
    const auto exact = RangeToDisc(ConeAt(apex, bearing), centre, radius);
    hits += exact.has_value();
    // Between two samples on the rim lie 2 pi r / 20000, at worst straight away from the apex.
    ASSERT_NO_FATAL_FAILURE(ExpectAgrees(exact, bearing, apex, 5e-4, [&](double u) {
      return centre + radius * Vec2{std::cos(2 * kPi * u), std::sin(2 * kPi * u)};
    }));
  }
  EXPECT_GT(hits, 100);
  EXPECT_LT(hits, 300);
}

TEST(Sonar, AWallIsAsNearAsItsNearestPointInTheCone) {
  Random random(22);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec2 apex = {random.Uniform(-1, 1), random.Uniform(-1, 1)};
    const double bearing = random.Uniform(-kPi, kPi);
    const Vec2 from = {random.Uniform(-4, 4), random.Uniform(-4, 4)};
    const Vec2 to = {random.Uniform(-4, 4), random.Uniform(-4, 4)};
    const auto exact = RangeToSegment(ConeAt(apex, bearing), from, to);
    hits += exact.has_value();
    ASSERT_NO_FATAL_FAILURE(
        ExpectAgrees(exact, bearing, apex, 1e-3, [&](double u) { return from + u * (to - from); }));
  }
  EXPECT_GT(hits, 60);
  EXPECT_LT(hits, 340);
}

TEST(Sonar, ADiscOnTheAxisIsMeasuredToItsShell) {
  EXPECT_DOUBLE_EQ(RangeToDisc(kCone, {2, 0}, 0.25).value(), 1.75);
}

// The centre is outside the cone; its edge is the nearest direction that still meets the disc.
TEST(Sonar, ADiscBesideTheAxisIsMetByTheConesEdge) {
  const double centre_angle = kHalfAngle + 0.05;
  const Vec2 centre = {2 * std::cos(centre_angle), 2 * std::sin(centre_angle)};
  const double expected =
      2 * std::cos(0.05) - std::sqrt(0.25 * 0.25 - 4 * std::pow(std::sin(0.05), 2));
  EXPECT_NEAR(RangeToDisc(kCone, centre, 0.25).value(), expected, 1e-12);
  EXPECT_NEAR(RangeToDisc(kCone, {centre.x, -centre.y}, 0.25).value(), expected, 1e-12);
  EXPECT_FALSE(RangeToDisc(kCone, centre, 0.09).has_value());
}

TEST(Sonar, NothingBehindTheTransducerIsHeard) {
  EXPECT_FALSE(RangeToDisc(kCone, {-1, 0}, 0.25).has_value());
  EXPECT_FALSE(RangeToSegment(kCone, {-1, -1}, {-1, 1}).has_value());
}

TEST(Sonar, InsideABodyTheRangeIsZero) {
  EXPECT_EQ(RangeToDisc(kCone, {0.1, 0.1}, 0.25), 0.0);
  EXPECT_EQ(RangeToDisc(kCone, {-0.1, 0}, 0.25), 0.0);
}

TEST(Sonar, NothingBeyondTheMaximumRangeIsHeard) {
  EXPECT_TRUE(RangeToDisc(kCone, {5.25, 0}, 0.25).has_value());
  EXPECT_FALSE(RangeToDisc(kCone, {5.2501, 0}, 0.25).has_value());
  EXPECT_FALSE(RangeToSegment(kCone, {5.01, -1}, {5.01, 1}).has_value());
}

TEST(Sonar, AWallAcrossTheAxisIsMeasuredToItsFoot) {
  EXPECT_DOUBLE_EQ(RangeToSegment(kCone, {2, -3}, {2, 3}).value(), 2);
}

TEST(Sonar, AWallEndingInsideTheConeIsMeasuredToItsEnd) {
  EXPECT_DOUBLE_EQ(RangeToSegment(kCone, {2, 0.1}, {2, 3}).value(), std::hypot(2, 0.1));
  EXPECT_DOUBLE_EQ(RangeToSegment(kCone, {3, 0}, {2, 0}).value(), 2);
}

// A wall alongside the transducer: the nearest point in the cone lies on its edge.
TEST(Sonar, AWallAlongsideIsMetByTheConesEdge) {
  EXPECT_NEAR(RangeToSegment(kCone, {-9, 0.5}, {9, 0.5}).value(), 0.5 / std::sin(kHalfAngle),
              1e-12);
  EXPECT_FALSE(RangeToSegment(kCone, {-9, 0.5}, {1, 0.5}).has_value());
}

TEST(Sonar, AWallThroughTheTransducerIsAtRangeZero) {
  Random random(23);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 apex = {random.Uniform(-9, 9), random.Uniform(-9, 9)};
    const double along = random.Uniform(-kPi, kPi);
    const Vec2 unit = {std::cos(along), std::sin(along)};
    const auto range = RangeToSegment(ConeAt(apex, random.Uniform(-kPi, kPi)), apex - 3 * unit,
                                      apex + random.Uniform(0, 2) * unit);
    ASSERT_TRUE(range.has_value());
    ASSERT_NEAR(*range, 0, 1e-9);
  }
}

TEST(Sonar, AWallWithoutLengthIsAPoint) {
  EXPECT_DOUBLE_EQ(RangeToSegment(kCone, {2, 0}, {2, 0}).value(), 2);
  EXPECT_FALSE(RangeToSegment(kCone, {2, 1}, {2, 1}).has_value());
}

TEST(SonarRing, TheOwnBodyIsNotHeard) {
  const SonarRing ring(PioneerP3dx());
  const Disc own = {{0, 0}, 0.25};
  for (const RangeReading& reading : ring.Sense({}, Tick{3}, {&own, 1}, 0, {})) {
    EXPECT_NE(reading.kind, Echo::kEcho);
  }
  // The same disc is detected at once when it is another vehicle's.
  EXPECT_EQ(ring.Sense({}, Tick{3}, {&own, 1}, 1, {})[0].range_m, 0);
}

TEST(SonarRing, TransducersSwitchedOffGiveNoDataAndTheOthersTheirTick) {
  const Readings readings = SonarRing(PioneerP3dx()).Sense({}, Tick{3}, {}, 0, {});
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    EXPECT_EQ(readings[i].kind, i < 8 ? Echo::kClear : Echo::kNoData) << i;
    EXPECT_EQ(readings[i].tick, i < 8 ? Tick{3} : kNoTick) << i;
  }
}

TEST(SonarRing, TheNearestOfSeveralThingsIsReported) {
  const Disc discs[] = {{{3, 0}, 0.25}, {{2, 0}, 0.25}, {{9, 9}, 0.25}};
  const Wall wall = {{4, -1}, {4, 1}};
  const Readings readings = SonarRing(PioneerP3dx()).Sense({}, Tick{1}, discs, 2, {&wall, 1});
  EXPECT_EQ(readings[3].kind, Echo::kEcho);
  EXPECT_NEAR(readings[3].range_m, std::hypot(2 - 0.166, 0.027) - 0.25, 1e-12);
}

TEST(SonarRing, AMirroredSceneGivesMirroredReadingsToTheBit) {
  RobotModel profile = PioneerP3dx();
  for (SensorMount& mount : profile.sonar) mount.enabled = true;
  const SonarRing ring(profile);
  Random random(24);
  int echoes = 0;
  for (int i = 0; i < 500; ++i) {
    const Disc disc = {{random.Uniform(-4, 4), random.Uniform(-4, 4)}, 0.25};
    const Wall wall = {{random.Uniform(-4, 4), random.Uniform(-4, 4)},
                       {random.Uniform(-4, 4), random.Uniform(-4, 4)}};
    const auto mirror = [](Vec2 p) { return Vec2{p.x, -p.y}; };
    const Disc mirrored_disc = {mirror(disc.centre_world), 0.25};
    const Wall mirrored_wall = {mirror(wall.from_world), mirror(wall.to_world)};
    const Readings seen = ring.Sense({}, Tick{1}, {&disc, 1}, 1, {&wall, 1});
    const Readings mirrored = ring.Sense({}, Tick{1}, {&mirrored_disc, 1}, 1, {&mirrored_wall, 1});
    for (std::size_t left = 0; left < kSensorCount; ++left) {
      const std::size_t right = left < 8 ? 7 - left : 23 - left;
      ASSERT_EQ(seen[left].kind, mirrored[right].kind) << left;
      ASSERT_EQ(seen[left].range_m, mirrored[right].range_m) << left;
      echoes += seen[left].kind == Echo::kEcho;
    }
  }
  EXPECT_GT(echoes, 500);
}

// Readings belong to the body: the whole scene turned and moved changes nothing.
TEST(SonarRing, ReadingsDoNotDependOnWhereTheWorldHasItsOrigin) {
  const SonarRing ring(PioneerP3dx());
  const Pose elsewhere = {.position_world = {12, -7}, .heading_rad = 2.2};
  const Vec2 centre_body = {1.5, 0.6};
  const Disc here = {centre_body, 0.25};
  const Disc there = {ToWorld(elsewhere, centre_body), 0.25};
  const Readings at_home = ring.Sense({}, Tick{1}, {&here, 1}, 1, {});
  const Readings away = ring.Sense(elsewhere, Tick{1}, {&there, 1}, 1, {});
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    EXPECT_EQ(at_home[i].kind, away[i].kind) << i;
    EXPECT_NEAR(at_home[i].range_m, away[i].range_m, 1e-12) << i;
  }
}

}  // namespace
}  // namespace giveway::sim

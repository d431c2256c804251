#include "sim_world/geometry/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/geometry/approach.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

constexpr double kRadius_m = 0.25;

Motion From(Vec2 position, double heading_rad, double forward_m_s, double turn_rad_s = 0,
            double dt_s = kDt_s) {
  return {.start_world = {position, heading_rad},
          .twist = {forward_m_s, turn_rad_s},
          .stop_s = dt_s,
          .radius_m = kRadius_m};
}

double DiscGap(const Motion& a, const Motion& b, double t_s) {
  return Norm(PositionAt(b, t_s) - PositionAt(a, t_s)) - 2 * kRadius_m;
}

TEST(Motion, HeadOnContactComesWhenTheGapIsUsedUp) {
  // 40 mm apart, closing at 0.9 m/s.
  const Motion a = From({0, 0}, 0, 0.4);
  const Motion b = From({0.54, 0}, kPi, 0.5);
  EXPECT_NEAR(FirstContact(a, b, 0, kDt_s).value(), 0.04 / 0.9, kTouch_m / 0.9);
}

// |p + w t| = 2 r solved in closed form.
TEST(Motion, ObliqueContactMatchesTheClosedForm) {
  const Motion a = From({0, 0}, 0, 1);
  const Motion b = From({0.4, 0.35}, -kPi / 2, 1);
  const double qa = 2;
  const double qb = -(0.4 + 0.35);
  const double qc = 0.4 * 0.4 + 0.35 * 0.35 - 0.25;
  const double expected = (-qb - std::sqrt(qb * qb - qa * qc)) / qa;
  EXPECT_NEAR(FirstContact(a, b, 0, kDt_s).value(), expected, 3e-6);
}

TEST(Motion, AWallIsMetByTheShell) {
  const Wall wall = {{1, -1}, {1, 1}};
  EXPECT_NEAR(FirstContact(From({0.73, 0}, 0, 0.5), wall, 0, kDt_s).value(), 0.04, 2e-6);
}

TEST(Motion, TheEndOfAWallIsMetRound) {
  const Wall wall = {{1, 0.15}, {1, 3}};
  const double reach = std::sqrt(kRadius_m * kRadius_m - 0.15 * 0.15);
  const Motion body = From({1 - reach - 0.02, 0}, 0, 1);
  EXPECT_NEAR(FirstContact(body, wall, 0, kDt_s).value(), 0.02, 3e-6);
}

TEST(Motion, TouchingBodiesThatMoveApartDoNotMeet) {
  const Motion a = From({0, 0}, kPi, 0.5);
  const Motion b = From({0.5, 0}, 0, 0);
  EXPECT_FALSE(FirstContact(a, b, 0, kDt_s).has_value());
}

TEST(Motion, TouchingBodiesThatCloseInMeetAtOnce) {
  const Motion a = From({0, 0}, 0, 0.5);
  const Motion b = From({0.5, 0}, 0, 0);
  EXPECT_EQ(FirstContact(a, b, 0, kDt_s), 0.0);
}

TEST(Motion, ABodySlidesAlongAWall) {
  const Wall wall = {{-5, 0.25}, {5, 0.25}};
  EXPECT_FALSE(FirstContact(From({0, 0}, 0, 1), wall, 0, kDt_s).has_value());
}

// Random arcs against a dense sampling: no penetration before the contact found, none missed.
TEST(Motion, ArcsNeverPassThroughEachOther) {
  Random random(31);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto arc = [&](Vec2 at) {
      return From(at, random.Uniform(-kPi, kPi), random.Uniform(-1, 1), random.Uniform(-2, 2), 1);
    };
    const Motion a = arc({0, 0});
    const double away = random.Uniform(0.51, 1.2);
    const double bearing = random.Uniform(-kPi, kPi);
    const Motion b = arc({away * std::cos(bearing), away * std::sin(bearing)});
    const auto contact = FirstContact(a, b, 0, 1);
    met += contact.has_value();
    for (int k = 0; k <= 500; ++k) {
      const double t_s = contact.value_or(1) * k / 500;
      ASSERT_GE(DiscGap(a, b, t_s), -1e-12) << i << ' ' << t_s;
    }
    if (contact) {
      ASSERT_LE(DiscGap(a, b, *contact), kTouch_m);
    }
  }
  EXPECT_GT(met, 300);
}

TEST(Motion, TheClosestMomentOfPassingBodiesLiesInsideTheTick) {
  const Motion a = From({-0.6, 0}, 0, 1, 0, 1);
  // p = (0.6, -1.5), w = (-1, 1): closest after 1.05 s, so at the end of one second.
  const Motion b = From({0, -1.5}, kPi / 2, 1, 0, 1.2);
  EXPECT_DOUBLE_EQ(ClosestWithin(a, b, 1).t_s, 1);
  const Motion nearer = From({0, -0.9}, kPi / 2, 1, 0, 1.2);
  // p = (0.6, -0.9): closest after 0.75 s, 0.15 sqrt 2 from centre to centre.
  const ClosestMoment passing = ClosestWithin(a, nearer, 1);
  EXPECT_NEAR(passing.t_s, 0.75, 1e-9);
  EXPECT_NEAR(passing.gap_m, 0.15 * std::sqrt(2) - 2 * kRadius_m, 1e-12);
}

TEST(Motion, TheClosestMomentIsAsLowAsAnySample) {
  Random random(32);
  for (int i = 0; i < 2000; ++i) {
    const auto arc = [&](Vec2 at) {
      Motion motion =
          From(at, random.Uniform(-kPi, kPi), random.Uniform(-1, 1), random.Uniform(-1.7, 1.7));
      if (random.Uniform(0, 1) < 0.3) motion.stop_s = random.Uniform(0, kDt_s);
      return motion;
    };
    const Motion a = arc({0, 0});
    const Motion b = arc({random.Uniform(0.5, 0.6), random.Uniform(-0.1, 0.1)});
    const ClosestMoment closest = ClosestWithin(a, b, kDt_s);
    ASSERT_NEAR(DiscGap(a, b, closest.t_s), closest.gap_m, 1e-15);
    for (int k = 0; k <= 1000; ++k) {
      ASSERT_LE(closest.gap_m, DiscGap(a, b, kDt_s * k / 1000) + 1e-9) << i << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace giveway::sim

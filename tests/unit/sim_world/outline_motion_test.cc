#include "sim_world/geometry/outline_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/geometry/approach.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

Motion BoxAt(Vec2 half_m, Pose start, Twist twist, double dt_s = kDt_s) {
  return {.start_world = start,
          .twist = twist,
          .stop_s = dt_s,
          .radius_m = Norm(half_m),
          .box_half_m = half_m};
}

Motion DiscAt(double radius_m, Pose start, Twist twist, double dt_s = kDt_s) {
  return {.start_world = start, .twist = twist, .stop_s = dt_s, .radius_m = radius_m};
}

Motion AnyMotion(Random* random, Vec2 at, bool box, double dt_s) {
  const Pose start = {at, random->Uniform(-kPi, kPi)};
  const Twist twist = {random->Uniform(-1, 1), random->Uniform(-3, 3)};
  if (box) {
    return BoxAt({random->Uniform(0.05, 0.4), random->Uniform(0.05, 0.4)}, start, twist, dt_s);
  }
  return DiscAt(random->Uniform(0.05, 0.4), start, twist, dt_s);
}

// The reference: time-stepping in fine steps. No overlap before the contact found, touching at it,
// and none missed.
template <typename A, typename B>
bool CheckAgainstSampling(const A& a, const B& b, double to_s, int samples) {
  if (GapAt(a, b, 0) <= kTouch_m) return false;
  const std::optional<double> contact = FirstContact(a, b, 0, to_s);
  for (int k = 0; k <= samples; ++k) {
    const double t_s = contact.value_or(to_s) * k / samples;
    EXPECT_GT(GapAt(a, b, t_s), 0) << t_s;
  }
  if (contact) {
    const double gap_m = GapAt(a, b, *contact);
    EXPECT_LE(gap_m, kTouch_m);
  }
  return contact.has_value();
}

TEST(OutlineMotion, BoxesAgreeWithFineSampling) {
  Random random(41);
  int met = 0;
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const Motion a = AnyMotion(&random, {0, 0}, true, 1);
    const double away = random.Uniform(0.3, 1.6);
    const double bearing = random.Uniform(-kPi, kPi);
    const Motion b = AnyMotion(&random, {away * std::cos(bearing), away * std::sin(bearing)},
                               random.Uniform(0, 1) < 0.5, 1);
    met += CheckAgainstSampling(a, b, 1, 400);
    met += CheckAgainstSampling(b, a, 1, 400);
    EXPECT_FALSE(HasFailure()) << i;
  }
  EXPECT_GT(met, 500);
}

TEST(OutlineMotion, BoxesAndWallsAgreeWithFineSampling) {
  Random random(42);
  int met = 0;
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const Motion box = AnyMotion(&random, {0, 0}, true, 1);
    const auto end = [&] { return Vec2{random.Uniform(-1, 1), random.Uniform(-1, 1)}; };
    const Wall wall = {end(), end()};
    met += CheckAgainstSampling(box, wall, 1, 400);
    EXPECT_FALSE(HasFailure()) << i;
  }
  EXPECT_GT(met, 300);
}

TEST(OutlineMotion, SlidingLeavesAgreeWithFineSampling) {
  Random random(43);
  int met = 0;
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const Motion body = AnyMotion(&random, {0, 0}, i % 2 == 0, 1);
    const Vec2 from = {random.Uniform(-1.5, 1.5), random.Uniform(-1.5, 1.5)};
    const Vec2 along = {random.Uniform(-1, 1), random.Uniform(-1, 1)};
    const Leaf leaf = {from, from + 0.4 * along, random.Uniform(-0.3, 1) * along, 1};
    met += CheckAgainstSampling(body, leaf, 1, 400);
    EXPECT_FALSE(HasFailure()) << i;
  }
  EXPECT_GT(met, 100);
}

// The time itself, against bisection of the sampled gap: to the micrometre at the speed of closing.
TEST(OutlineMotion, TheTimeOfContactIsThatOfBisection) {
  Random random(44);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Motion a = AnyMotion(&random, {0, 0}, true, 1);
    const Motion b = AnyMotion(&random, {random.Uniform(0.5, 1), 0}, i % 2 == 0, 1);
    if (GapAt(a, b, 0) <= kTouch_m) continue;
    const std::optional<double> contact = FirstContact(a, b, 0, 1);
    if (!contact) continue;
    // Continue until the shells overlap or part; the moment the gap is zero lies in between.
    double before_s = *contact;
    double after_s = before_s;
    while (after_s < before_s + 1e-4 && GapAt(a, b, after_s) > 0) after_s += 1e-7;
    if (GapAt(a, b, after_s) > 0) continue;  // grazed
    ++met;
    while (after_s - before_s > 1e-12) {
      const double middle_s = (before_s + after_s) / 2;
      (GapAt(a, b, middle_s) > 0 ? before_s : after_s) = middle_s;
    }
    const double rate = (GapAt(a, b, *contact) - GapAt(a, b, *contact - 1e-7)) / 1e-7;
    EXPECT_LE((after_s - *contact) * -rate, 2 * kTouch_m) << i;
  }
  EXPECT_GT(met, 300);
}

// After a contact, motion in every direction: shells never penetrate by more than the tolerance of
// a contact, and no motion that separates them is blocked.
TEST(OutlineMotion, TouchingBoxesGoOnWithoutSinkingIn) {
  Random random(46);
  int parted = 0;
  int held = 0;
  for (int i = 0; i < 4000 && !HasFailure(); ++i) {
    Motion a = AnyMotion(&random, {0, 0}, true, 1);
    Motion b = AnyMotion(&random, {random.Uniform(0.5, 1), 0}, i % 2 == 0, 1);
    if (GapAt(a, b, 0) <= kTouch_m) continue;
    const std::optional<double> contact = FirstContact(a, b, 0, 1);
    if (!contact) continue;
    for (Motion* motion : {&a, &b}) {
      motion->start_world = PoseAt(*motion, *contact);
      motion->stop_s = kDt_s;
      motion->twist = {random.Uniform(-1, 1), random.Uniform(-3, 3)};
    }
    const std::optional<double> again = FirstContact(a, b, 0, kDt_s);
    (again ? held : parted) += 1;
    for (int k = 0; k <= 100; ++k) {
      EXPECT_GT(GapAt(a, b, again.value_or(kDt_s) * k / 100), -kTouch_m) << i;
    }
    if (GapAt(a, b, 1e-6) > kTouch_m + 1e-8 && again) {
      EXPECT_GT(*again, 1e-6) << i;
    }
  }
  EXPECT_GT(parted, 100);
  EXPECT_GT(held, 100);
}

TEST(OutlineMotion, ABoxTurningInPlaceMeetsAWallWithItsCorner) {
  // The corner is 0.5 m from the centre, 0.6435 rad off the length; the wall 0.45 m ahead.
  const Motion box = BoxAt({0.4, 0.3}, {{0, 0}, 0}, {0, 1}, 1);
  const Wall wall = {{0.45, -2}, {0.45, 2}};
  const double corner_rad = std::atan2(0.3, 0.4);
  const double expected = corner_rad - std::acos(0.45 / 0.5);
  const double closing = 0.5 * std::sin(corner_rad - expected);
  EXPECT_NEAR(FirstContact(box, wall, 0, 1).value(), expected, kTouch_m / closing);
}

TEST(OutlineMotion, BoxesThatTurnInPlaceMeetCornerToSide) {
  const Motion turning = BoxAt({0.4, 0.3}, {{0, 0}, 0}, {0, -1}, 1);
  const Motion standing = BoxAt({0.2, 1}, {{0.65, 0}, 0}, {});
  const double corner_rad = std::atan2(0.3, 0.4);
  EXPECT_NEAR(FirstContact(turning, standing, 0, 1).value(), corner_rad - std::acos(0.45 / 0.5),
              5e-6);
}

TEST(OutlineMotion, ABoxMeetsADiscFlatOn) {
  const Motion box = BoxAt({0.3, 0.2}, {{0, 0}, 0}, {0.5, 0});
  const Motion disc = DiscAt(0.25, {{0.56, 0.1}, 0}, {});
  EXPECT_NEAR(FirstContact(box, disc, 0, kDt_s).value(), 0.02, kTouch_m / 0.5);
}

TEST(OutlineMotion, ABoxSlidesAlongAWall) {
  const Motion box = BoxAt({0.3, 0.2}, {{0, 0}, 0}, {1, 0});
  EXPECT_FALSE(FirstContact(box, Wall{{-5, 0.2}, {5, 0.2}}, 0, kDt_s).has_value());
  EXPECT_FALSE(FirstContact(box, Wall{{-5, 0.2}, {0.1, 0.2}}, 0, kDt_s).has_value());
}

// However long the wall: its far ends must not tilt what counts as flat.
TEST(OutlineMotion, ABoxFlatOnAWallMayTurnNeitherWayButSlideAndLeave) {
  for (int i = 0; i < 200; ++i) {
    const double heading = -3 + 0.03 * i;
    const Pose pose = {{3, -2}, heading};
    const Wall wall = {ToWorld(pose, {-30.0 - i, 0.2 + 5e-7}),
                       ToWorld(pose, {0.1 + 0.5 * i, 0.2 + 5e-7})};
    const auto contact = [&](Twist twist) {
      return FirstContact(BoxAt({0.3, 0.2}, pose, twist), wall, 0, kDt_s);
    };
    EXPECT_EQ(contact({0, 1}), 0.0) << i;
    EXPECT_EQ(contact({0, -1}), 0.0) << i;
    EXPECT_FALSE(contact({1, 0})) << i;
  }
}

// Beyond the end of the wall the side comes nearer to the wall's line: that is no contact.
TEST(OutlineMotion, ABoxTurnsAwayFromAWallsEndItTouches) {
  const Motion box = BoxAt({0.3, 0.2}, {{0, 0}, 0}, {0, -1});
  const Wall behind = {{-5, 0.2 + 5e-7}, {-0.1, 0.2 + 5e-7}};
  EXPECT_TRUE(FirstContact(BoxAt({0.3, 0.2}, {{0, 0}, 0}, {0, -1}), behind, 0, kDt_s));
  const Motion away = BoxAt({0.3, 0.2}, {{0, 0}, 0}, {0, 1});
  EXPECT_FALSE(FirstContact(away, behind, 0, kDt_s).has_value());
  EXPECT_FALSE(FirstContact(box, Wall{{0.1, 0.2 + 5e-7}, {5, 0.2 + 5e-7}}, 0, kDt_s).has_value());
}

TEST(OutlineMotion, BoxesSideBySideSlideButDoNotTurnIntoEachOther) {
  const Motion a = BoxAt({0.3, 0.2}, {{0, 0}, 0}, {0.3, -0.5});
  const Motion b = BoxAt({0.3, 0.2}, {{0.35, 0.4 + 3e-7}, 0}, {0.3, 0.5});
  EXPECT_TRUE(FirstContact(a, b, 0, kDt_s).has_value());  // the rear corner of b swings into a
  const Motion ahead = BoxAt({0.3, 0.2}, {{0.35, 0.4 + 3e-7}, 0}, {0.3, 0});
  EXPECT_FALSE(FirstContact(BoxAt({0.3, 0.2}, {{0, 0}, 0}, {0.3, 0}), ahead, 0, kDt_s));
}

TEST(OutlineMotion, TheClosestMomentOfBoxesIsAsLowAsAnySample) {
  Random random(45);
  for (int i = 0; i < 2000 && !HasFailure(); ++i) {
    Motion a = AnyMotion(&random, {0, 0}, true, 0.2);
    Motion b = AnyMotion(&random, {random.Uniform(0.9, 1.2), 0}, i % 2 == 0, 0.2);
    if (i % 3 == 0) a.stop_s = random.Uniform(0, 0.2);
    if (GapAt(a, b, 0) <= 0 || FirstContact(a, b, 0, std::min(a.stop_s, b.stop_s))) continue;
    const ClosestMoment closest = ClosestWithin(a, b, 0.2);
    EXPECT_NEAR(GapAt(a, b, closest.t_s), closest.gap_m, 1e-12);
    for (int k = 0; k <= 500; ++k) {
      EXPECT_LE(closest.gap_m, GapAt(a, b, 0.2 * k / 500) + kTouch_m) << i << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace giveway::sim

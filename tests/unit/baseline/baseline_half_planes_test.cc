#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "tests/bench/baseline/half_planes.h"
#include "tests/bench/baseline/rvo.h"

namespace giveway::bench {
namespace {

constexpr double kTop = 1;

Vec2 Direction(double angle_rad) { return {Cos(angle_rad), Sin(angle_rad)}; }

std::vector<HalfPlane> AnyPlanes(Random* dice, double reach) {
  std::vector<HalfPlane> planes;
  const auto count = 1 + dice->Next() % 6;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vec2 normal = Direction(dice->Uniform(-kPi, kPi));
    planes.push_back({dice->Uniform(-reach, reach) * normal, normal});
  }
  return planes;
}

// How deep the velocity breaks the worst broken plane; negative where it breaks none.
double Worst(const std::vector<HalfPlane>& planes, Vec2 velocity) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const HalfPlane& plane : planes) worst = std::max(worst, -Inside(plane, velocity));
  return worst;
}

template <typename Visit>
void ForEachVelocity(Visit visit) {
  constexpr int kSteps = 40;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Vec2 velocity{kTop * i / kSteps, kTop * j / kSteps};
      if (Norm(velocity) <= kTop) visit(velocity);
    }
  }
}

TEST(HalfPlanes, TheWantedVelocityIsGivenWhereItIsAllowed) {
  const std::vector<HalfPlane> planes = {{{0, 0}, {1, 0}}};
  EXPECT_EQ(NearestAllowed(planes, kTop, {0.5, 0.2}), (Vec2{0.5, 0.2}));
}

TEST(HalfPlanes, WhatIsWantedTooFastIsSlowed) {
  EXPECT_EQ(NearestAllowed({}, kTop, {3, 0}), (Vec2{1, 0}));
}

TEST(HalfPlanes, TheAnswerIsAllowedByAllAndNoneAllowedIsNearer) {
  Random dice(1);
  int answered = 0;
  for (int turn = 0; turn < 400; ++turn) {
    const std::vector<HalfPlane> planes = AnyPlanes(&dice, 0.7);
    const Vec2 wanted = dice.Uniform(0, 1.5) * Direction(dice.Uniform(-kPi, kPi));
    const std::optional<Vec2> answer = NearestAllowed(planes, kTop, wanted);
    if (answer) {
      ++answered;
      EXPECT_LE(Worst(planes, *answer), 1e-9);
      EXPECT_LE(Norm(*answer), kTop + 1e-9);
    }
    ForEachVelocity([&](Vec2 velocity) {
      if (Worst(planes, velocity) > 0) return;
      ASSERT_TRUE(answer);
      ASSERT_LE(Norm(*answer - wanted), Norm(velocity - wanted) + 1e-9);
    });
  }
  EXPECT_GT(answered, 100);
  EXPECT_LT(answered, 390);
}

TEST(HalfPlanes, WhereNothingIsAllowedTheWorstBrokenIsBrokenLeast) {
  Random dice(2);
  int refused = 0;
  for (int turn = 0; turn < 400; ++turn) {
    const std::vector<HalfPlane> planes = AnyPlanes(&dice, 2);
    if (NearestAllowed(planes, kTop, {})) continue;
    ++refused;
    const Vec2 answer = NearestTolerable(planes, kTop, {});
    EXPECT_LE(Norm(answer), kTop + 1e-9);
    ForEachVelocity(
        [&](Vec2 velocity) { ASSERT_LE(Worst(planes, answer), Worst(planes, velocity) + 1e-6); });
  }
  EXPECT_GT(refused, 50);
}

TEST(HalfPlanes, TwoThatKeepToTheirPlanesStayApart) {
  Random dice(3);
  constexpr double kHorizon_s = 4;
  for (int turn = 0; turn < 2000; ++turn) {
    const auto velocity = [&] { return dice.Uniform(0, 1) * Direction(dice.Uniform(-kPi, kPi)); };
    const Mover a = {{0, 0}, velocity(), 0.4};
    const Mover b = {dice.Uniform(0.9, 4) * Direction(dice.Uniform(-kPi, kPi)), velocity(), 0.4};
    const HalfPlane planes[] = {ReciprocalPlane(a, b, kHorizon_s, 0.05),
                                ReciprocalPlane(b, a, kHorizon_s, 0.05)};
    const std::optional<Vec2> of_a = NearestAllowed({&planes[0], 1}, 2, velocity());
    const std::optional<Vec2> of_b = NearestAllowed({&planes[1], 1}, 2, velocity());
    if (!of_a || !of_b) continue;
    for (double at_s = 0; at_s <= kHorizon_s; at_s += 0.05) {
      const Vec2 apart = b.position_world - a.position_world + at_s * (*of_b - *of_a);
      ASSERT_GE(Norm(apart), 0.8 - 1e-6) << "case " << turn << " at " << at_s << " s";
    }
  }
}

}  // namespace
}  // namespace giveway::bench

// Do bodies overlap at the start? The geometry against cases with a known answer and against
// sampled points; the sweep against all pairs.
#include "services/config/start_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "services/config/start_sweep.h"
#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway {
namespace {

StartShape Disc(Vec2 at, double radius_m) { return {BodyShape::kDisc, {at, 0}, radius_m, {}}; }
StartShape Box(Vec2 at, double heading_deg, Vec2 half_m) {
  return {BodyShape::kBox, {at, Radians(heading_deg)}, Norm(half_m), half_m};
}

bool Holds(const StartShape& shape, Vec2 point_world) {
  const Vec2 p = ToBody(shape.world_from_body, point_world);
  if (shape.shape == BodyShape::kDisc) return Norm(p) <= shape.radius_m;
  return p.x >= -shape.box_half_m.x && p.x <= shape.box_half_m.x && p.y >= -shape.box_half_m.y &&
         p.y <= shape.box_half_m.y;
}

TEST(StartShape, DiscsTouchAtTheSumOfTheirRadii) {
  EXPECT_TRUE(Overlap(Disc({0, 0}, 0.25), Disc({0.5, 0}, 0.25)));
  EXPECT_FALSE(Overlap(Disc({0, 0}, 0.25), Disc({0.500001, 0}, 0.25)));
}

TEST(StartShape, ABoxIsJudgedByItsSidesAndNotByTheDiscThatHoldsIt) {
  const StartShape lying = Box({0, 0}, 0, {0.5, 0.1});
  EXPECT_FALSE(Overlap(lying, Box({0, 0.21}, 0, {0.5, 0.1})));
  EXPECT_TRUE(Overlap(lying, Box({0, 0.19}, 0, {0.5, 0.1})));
  EXPECT_FALSE(Overlap(lying, Disc({0, 0.36}, 0.25)));
  EXPECT_TRUE(Overlap(lying, Disc({0, 0.34}, 0.25)));
  EXPECT_TRUE(Overlap(Disc({0, 0.34}, 0.25), lying));
}

// Corner towards side: only a direction along a side of the turned box separates them.
TEST(StartShape, ATurnedBoxIsApartWhereOnlyItsOwnSidesShowIt) {
  const StartShape square = Box({0, 0}, 0, {1, 1});
  EXPECT_FALSE(Overlap(square, Box({1.8, 1.8}, 45, {1, 1})));
  EXPECT_TRUE(Overlap(square, Box({1.6, 1.6}, 45, {1, 1})));
}

TEST(StartShape, ADiscAtACornerIsMeasuredToTheCorner) {
  const StartShape square = Box({0, 0}, 0, {1, 1});
  EXPECT_FALSE(Overlap(square, Disc({1.2, 1.2}, 0.28)));
  EXPECT_TRUE(Overlap(square, Disc({1.2, 1.2}, 0.29)));
}

TEST(StartShape, ALineThroughABoxOrInsideItOverlaps) {
  const StartShape box = Box({2, 1}, 30, {0.5, 0.2});
  EXPECT_TRUE(Overlap(box, StartLine{{-5, 1}, {9, 1}}));
  EXPECT_TRUE(Overlap(box, StartLine{{2, 1}, {2.01, 1}}));
  EXPECT_FALSE(Overlap(box, StartLine{{-5, 1}, {1.4, 1}}));
  EXPECT_FALSE(Overlap(box, StartLine{{1.7, 1.4}, {2.6, 1.9}}));  // next to its long side
}

TEST(StartShape, WhatIsNotFiniteOverlapsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Overlap(Disc({nan, 0}, 1), Disc({0, 0}, 1)));
  EXPECT_FALSE(Overlap(Box({0, 0}, 0, {nan, 1}), Box({0, 0}, 0, {1, 1})));
  EXPECT_FALSE(Overlap(Box({0, 0}, 0, {1, 1}), StartLine{{nan, 0}, {1, 0}}));
  EXPECT_FALSE(Overlap(Disc({0, 0}, 1), StartLine{{0, 0}, {nan, 0}}));
}

TEST(StartShape, LinesThatMeetAtAnEndOrLieAlongEachOtherDoNotCross) {
  EXPECT_TRUE(Cross(StartLine{{-1, 0}, {1, 0}}, StartLine{{0, -1}, {0, 1}}));
  EXPECT_FALSE(Cross(StartLine{{-1, 0}, {1, 0}}, StartLine{{0, 0}, {0, 1}}));
  EXPECT_FALSE(Cross(StartLine{{-1, 0}, {1, 0}}, StartLine{{0, 0}, {3, 0}}));
  EXPECT_FALSE(Cross(StartLine{{-1, 0}, {1, 0}}, StartLine{{2, -1}, {2, 1}}));
}

StartShape Any(Random* random) {
  const Vec2 at{random->Uniform(-1, 1), random->Uniform(-1, 1)};
  if (random->Uniform(0, 1) < 0.4) return Disc(at, random->Uniform(0.05, 0.6));
  return Box(at, random->Uniform(-180, 180),
             {random->Uniform(0.05, 0.6), random->Uniform(0.05, 0.6)});
}

// A point of both proves an overlap. Overlaps without such a point on a fine raster are thin.
TEST(StartShape, AgreesWithASearchForAPointOfBoth) {
  Random random(7);
  int thin = 0;
  int overlaps = 0;
  for (int pair = 0; pair < 2000; ++pair) {
    const StartShape a = Any(&random);
    const StartShape b = Any(&random);
    bool shared = false;
    for (int i = 0; i <= 60 && !shared; ++i) {
      for (int j = 0; j <= 60 && !shared; ++j) {
        const Vec2 p{-2 + i / 15.0, -2 + j / 15.0};
        shared = Holds(a, p) && Holds(b, p);
      }
    }
    const bool overlap = Overlap(a, b);
    EXPECT_EQ(overlap, Overlap(b, a));
    ASSERT_TRUE(overlap || !shared) << pair;
    overlaps += overlap;
    thin += overlap && !shared;
  }
  EXPECT_GT(overlaps, 500);
  EXPECT_LT(thin, overlaps / 8);
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

bool Meet(const Bounds& a, const Bounds& b) {
  return a.low_world.x <= b.high_world.x && b.low_world.x <= a.high_world.x &&
         a.low_world.y <= b.high_world.y && b.low_world.y <= a.high_world.y;
}

// All pairs of bodies, and of bodies and lines, compared one by one.
std::pair<Pairs, Pairs> AllPairs(const std::vector<Bounds>& bodies,
                                 const std::vector<Bounds>& lines) {
  Pairs both;
  Pairs mixed;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      if (Meet(bodies[i], bodies[j])) both.emplace_back(i, j);
    }
    for (std::size_t j = 0; j < lines.size(); ++j) {
      if (Meet(bodies[i], lines[j])) mixed.emplace_back(i, j);
    }
  }
  return {both, mixed};
}

TEST(StartSweep, FindsEachPairOnce) {
  Random random(11);
  for (const Vec2 spread : {Vec2{5, 5}, Vec2{1, 9}, Vec2{9, 1}, Vec2{0, 0}}) {
    std::vector<Bounds> bodies;
    std::vector<Bounds> lines;
    for (int i = 0; i < 60; ++i) {
      const auto place = [&] {
        return Vec2{random.Uniform(-spread.x, spread.x), random.Uniform(-spread.y, spread.y)};
      };
      StartShape shape = Any(&random);
      shape.world_from_body.position_world = place();
      bodies.push_back(BoundsOf(shape));
      lines.push_back(BoundsOf(StartLine{place(), place()}));
    }
    Pairs both;
    Pairs mixed;
    Sweep(bodies, lines,
          {[&](std::size_t a, std::size_t b) { both.emplace_back(a, b); },
           [&](std::size_t body, std::size_t line) { mixed.emplace_back(body, line); }});
    std::sort(both.begin(), both.end());
    std::sort(mixed.begin(), mixed.end());
    EXPECT_EQ(std::make_pair(both, mixed), AllPairs(bodies, lines));
  }
}

}  // namespace
}  // namespace giveway

// Echoes stay where they were: how the grid gains, loses, scrolls and forgets.
#include "services/vehicle/estimation/obstacle_grid.h"

#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway {
namespace {

// A transducer on the nose that looks straight ahead.
HeardCone Ahead(bool echo, double range_m = 0, double bearing_rad = 0) {
  return {.apex_body = {0.15, 0},
          .axis_body = {Cos(bearing_rad), Sin(bearing_rad)},
          .half_sine = Sin(Radians(15)),
          .echo = echo,
          .range_m = range_m,
          .unsure_m = 0.02 * range_m,
          .enters = true};
}

void HearTimes(ObstacleGrid* grid, int times, double range_m = 0.6) {
  for (int i = 0; i < times; ++i) grid->Hear(Ahead(true, range_m), {});
}

// An echo 0.6 m ahead of the nose.
constexpr Vec2 kThere = {0.75, 0};

bool Holds(const ObstacleGrid& grid, Vec2 point_body) {
  return grid.At(point_body) >= ObstacleGrid::kHeld;
}

TEST(ObstacleGrid, AnEchoIsHeldOnItsArcAndNowhereElse) {
  ObstacleGrid grid;
  EXPECT_FALSE(grid.IsActive());
  HearTimes(&grid, 1);
  EXPECT_TRUE(grid.IsActive());
  EXPECT_TRUE(Holds(grid, kThere));
  EXPECT_TRUE(Holds(grid, {0.15 + 0.6 * Cos(0.2), 0.6 * Sin(0.2)}));
  EXPECT_FALSE(Holds(grid, {0.45, 0}));
  EXPECT_FALSE(Holds(grid, {1.05, 0}));
  EXPECT_FALSE(Holds(grid, {0.5, 0.5}));
  grid.Held([](Vec2 place) { EXPECT_NEAR(Norm(place - Vec2{0.15, 0}), 0.6, 0.1); });
}

TEST(ObstacleGrid, AnEchoFromFarAwayIsNotEntered) {
  ObstacleGrid grid;
  HearTimes(&grid, 3, 1.5);
  EXPECT_FALSE(Holds(grid, {1.65, 0}));
}

TEST(ObstacleGrid, WhatIsHeardClearIsForgottenAfterAFewFirings) {
  ObstacleGrid grid;
  HearTimes(&grid, 5);
  grid.Hear(Ahead(false), {});
  EXPECT_TRUE(Holds(grid, kThere)) << "one drop-out forgets nothing";
  int more = 0;
  while (Holds(grid, kThere) && more < 10) {
    grid.Hear(Ahead(false), {});
    ++more;
  }
  EXPECT_GE(more, 2);
  EXPECT_LE(more, 4);
}

TEST(ObstacleGrid, AnEchoFromBehindThePlaceClearsItAndOneFromBeforeDoesNot) {
  ObstacleGrid grid;
  HearTimes(&grid, 3);
  for (int i = 0; i < 8; ++i) grid.Hear(Ahead(true, 0.3), {});
  EXPECT_TRUE(Holds(grid, kThere));
  for (int i = 0; i < 8; ++i) grid.Hear(Ahead(true, 1.2), {});
  EXPECT_FALSE(Holds(grid, kThere));
}

// There an edge would not be detected either.
TEST(ObstacleGrid, SilenceAtTheRimOfAConeClearsNearPlacesOnly) {
  const double rim_rad = Radians(14.5);
  for (const double range_m : {0.3, 0.9}) {
    ObstacleGrid grid;
    for (int i = 0; i < 3; ++i) grid.Hear(Ahead(true, range_m, rim_rad), {});
    const Vec2 there = Vec2{0.15, 0} + range_m * Vec2{Cos(rim_rad), Sin(rim_rad)};
    ASSERT_TRUE(Holds(grid, there));
    for (int i = 0; i < 20; ++i) grid.Hear(Ahead(false), {});
    EXPECT_EQ(Holds(grid, there), range_m > 0.5) << range_m;
  }
}

TEST(ObstacleGrid, WhatWasHeardOutOfTheConesStays) {
  ObstacleGrid grid;
  HearTimes(&grid, 3);
  grid.Move({0, 0}, Radians(70), 0);
  for (int i = 0; i < 200; ++i) {
    grid.Hear(Ahead(false), {});
    grid.Fade(0.05);
  }
  EXPECT_TRUE(Holds(grid, {0.75 * Cos(Radians(70)), -0.75 * Sin(Radians(70))}));
}

TEST(ObstacleGrid, WhatWasHeardOnceFadesAndWhatWasHeardTwiceDoesNot) {
  ObstacleGrid once;
  HearTimes(&once, 1);
  ObstacleGrid twice;
  HearTimes(&twice, 2);
  for (int i = 0; i < 100; ++i) {
    once.Fade(0.05);
    twice.Fade(0.05);
  }
  EXPECT_FALSE(Holds(once, kThere));
  EXPECT_TRUE(Holds(twice, kThere));
}

TEST(ObstacleGrid, WhatMovesFadesHoweverOftenItIsHeard) {
  ObstacleGrid grid;
  HeardCone mover = Ahead(true, 0.6);
  mover.moves = true;
  for (int i = 0; i < 10; ++i) grid.Hear(mover, {});
  EXPECT_TRUE(Holds(grid, kThere));
  for (int i = 0; i < 100; ++i) grid.Fade(0.05);
  EXPECT_FALSE(Holds(grid, kThere));
}

// The middle of a cell 0.1 m before a transducer.
constexpr Vec2 kNear = {0.25, 0.05};

HeardCone Near(bool echo) {
  HeardCone heard = Ahead(echo, 0.14);
  heard.apex_body = {0.15, 0.05};
  return heard;
}

// From corridor 211 with a mixed fleet: a vehicle stood before the end of a wall, turned on the
// spot until it was between two cones, took it for gone and drove into it.
TEST(ObstacleGrid, WhatIsHeardNearIsNotGoneBetweenTwoCones) {
  const auto held_after_turning = [](int echoes) {
    constexpr double kTurned_rad = 0.1;
    ObstacleGrid grid;
    for (int i = 0; i < echoes; ++i) grid.Hear(Near(true), {});
    grid.Move({0, 0}, kTurned_rad, 0);
    const Vec2 there = Cos(kTurned_rad) * kNear - Sin(kTurned_rad) * Left(kNear);
    EXPECT_TRUE(Holds(grid, there));
    for (int i = 0; i < 10; ++i) grid.Hear(Near(false), {});
    return Holds(grid, there);
  };
  EXPECT_TRUE(held_after_turning(2));
  EXPECT_FALSE(held_after_turning(1)) << "which may be a mistake";
}

TEST(ObstacleGrid, WhatWasHeardNearIsClearOnceOneConeHoldsAllOfItsCell) {
  ObstacleGrid grid;
  for (int i = 0; i < 5; ++i) grid.Hear(Near(true), {});
  grid.Move({-0.3, 0}, 0, 0);
  const Vec2 there = kNear + Vec2{0.3, 0};
  ASSERT_TRUE(Holds(grid, there));
  for (int i = 0; i < 10; ++i) grid.Hear(Near(false), {});
  EXPECT_FALSE(Holds(grid, there));
}

TEST(ObstacleGrid, WhatWasHeardNearIsForgottenAsItsPlaceGrowsUnsure) {
  const auto held_after = [](double unsure_m) {
    ObstacleGrid grid;
    for (int i = 0; i < 5; ++i) grid.Hear(Near(true), {});
    for (int i = 0; i < 100; ++i) grid.Move({0, 0}, 0, unsure_m * unsure_m / 100);
    return Holds(grid, kNear);
  };
  EXPECT_TRUE(held_after(0.06));
  EXPECT_FALSE(held_after(0.12));
  EXPECT_FALSE(held_after(1e10));
}

TEST(ObstacleGrid, APeerKnownByItsBeaconsIsNotEntered) {
  ObstacleGrid grid;
  const KnownBody peer = {.centre_body = {1.0, 0}, .radius_m = 0.4};
  for (int i = 0; i < 3; ++i) grid.Hear(Ahead(true, 0.6), {&peer, 1});
  EXPECT_FALSE(Holds(grid, kThere));
  HeardCone explained = Ahead(true, 0.6);
  explained.enters = false;
  for (int i = 0; i < 3; ++i) grid.Hear(explained, {});
  EXPECT_FALSE(Holds(grid, kThere));
}

TEST(ObstacleGrid, TheMoreUnsureTheWaySinceTheLessItHolds) {
  const auto held_after = [](double unsure_m) {
    ObstacleGrid grid;
    HearTimes(&grid, 5);
    for (int i = 0; i < 100; ++i) grid.Move({0, 0}, 0, unsure_m * unsure_m / 100);
    return Holds(grid, kThere);
  };
  EXPECT_TRUE(held_after(0));
  EXPECT_TRUE(held_after(0.06));
  EXPECT_FALSE(held_after(0.12));
}

TEST(ObstacleGrid, WhatIsUnsureAtOnceIsForgottenAsWhatGrowsUnsure) {
  const auto held_at = [](int steps) {
    ObstacleGrid grid;
    HearTimes(&grid, 5);
    for (int i = 0; i < steps; ++i) grid.Move({0, 0}, 0, 0.09 * 0.09 / steps);
    return grid.At(kThere);
  };
  EXPECT_EQ(held_at(1), held_at(1000));
  EXPECT_EQ(held_at(1), ObstacleGrid::kSurest - 3 * 3);
  ObstacleGrid grid;
  HearTimes(&grid, 5);
  grid.Move({0, 0}, 0, 1e300);
  EXPECT_EQ(grid.At(kThere), 0);
}

TEST(ObstacleGrid, BeforeAnythingIsHeardTimeAndWayLeaveNoTrace) {
  ObstacleGrid rolled;
  for (int i = 0; i < 17; ++i) {
    rolled.Move({0.03, 0.01}, 0.2, 0.001);
    rolled.Fade(0.05);
  }
  ObstacleGrid fresh;
  for (ObstacleGrid* grid : {&rolled, &fresh}) HearTimes(grid, 2);
  StateHash of_rolled, of_fresh;
  rolled.AddTo(&of_rolled);
  fresh.AddTo(&of_fresh);
  EXPECT_EQ(of_rolled.Value(), of_fresh.Value());
}

TEST(ObstacleGrid, WhereTheOwnBodyStandsNothingElseDoes) {
  ObstacleGrid grid;
  HearTimes(&grid, 3);
  for (int i = 0; i < 15; ++i) grid.Move({0.05, 0}, 0, 0);
  ASSERT_TRUE(Holds(grid, {0, 0}));
  grid.StandsOn(0.2);
  EXPECT_FALSE(Holds(grid, {0, 0}));
}

// Against a list of where things are, over paths that lead several times round the torus.
TEST(ObstacleGrid, ScrollsWithTheVehicleAndKeepsWhatIsNear) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    ObstacleGrid grid;
    Pose world_from_body;
    const double drift_rad = random.Uniform(-0.05, 0.05);
    for (int i = 0; i < 600; ++i) {
      const Pose before = world_from_body;
      world_from_body =
          AdvanceArc(before, {0.4, drift_rad + random.Uniform(-1, 1)}, 0.05 * random.Uniform(0, 4));
      grid.Move(ToBody(before, world_from_body.position_world),
                world_from_body.heading_rad - before.heading_rad, 0);
      if (i % 40 != 0) continue;
      ObstacleGrid heard = grid;
      HearTimes(&heard, 2);
      const Vec2 thing_world = ToWorld(world_from_body, kThere);
      Pose on = world_from_body;
      for (int j = 0; j < 40; ++j) {
        const Pose last = on;
        on = AdvanceArc(last, {0.4, 0.3}, 0.05);
        heard.Move(ToBody(last, on.position_world), on.heading_rad - last.heading_rad, 0);
        double nearest_m = 1e9;
        heard.Held([&](Vec2 place) {
          nearest_m = std::min(nearest_m, Norm(place - ToBody(on, thing_world)));
        });
        ASSERT_LT(nearest_m, 0.11) << seed << " " << i << " " << j;
      }
    }
    // What it has left behind is gone: five metres on, nothing of an echo is left.
    HearTimes(&grid, 3);
    for (int i = 0; i < 100; ++i) grid.Move({0.05, 0}, 0, 0);
    int held = 0;
    grid.Held([&](Vec2) { ++held; });
    ASSERT_EQ(held, 0) << seed;
  }
}

TEST(ObstacleGrid, AJumpBeyondItsSizeForgetsEverything) {
  ObstacleGrid grid;
  HearTimes(&grid, 3);
  grid.Move({5, 0}, 0, 0);
  int held = 0;
  grid.Held([&](Vec2) { ++held; });
  EXPECT_EQ(held, 0);
}

TEST(ObstacleGrid, TheSameStateHashesAlikeAndAnotherDoesNot) {
  const auto hash_of = [](const ObstacleGrid& grid) {
    StateHash hash;
    grid.AddTo(&hash);
    return hash.Value();
  };
  ObstacleGrid a;
  EXPECT_EQ(hash_of(a), StateHash().Value()) << "a grid that takes nothing in changes no hash";
  HearTimes(&a, 2);
  ObstacleGrid b = a;
  EXPECT_EQ(hash_of(a), hash_of(b));
  b.Hear(Ahead(false), {});
  EXPECT_NE(hash_of(a), hash_of(b));
}

}  // namespace
}  // namespace giveway

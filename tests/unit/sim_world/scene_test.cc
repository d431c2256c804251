#include "sim_world/sensors/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::sim {
namespace {

using testing::IsSupersetOf;

Vec2 Somewhere(Random* random, double extent_m) {
  return {random->Uniform(-extent_m, extent_m), random->Uniform(-extent_m, extent_m)};
}

bool Reaches(const SceneSegment& segment, Vec2 point, double reach_m) {
  return Norm(NearestOnSegment(segment.from_world, segment.to_world, point) - point) <= reach_m;
}

std::set<Owner> DiscOwnersNear(const Scene& scene, Vec2 centre, double reach_m) {
  std::set<Owner> owners;
  scene.DiscsNear(centre, reach_m, [&](std::uint32_t begin, std::uint32_t end) {
    for (; begin != end; ++begin) EXPECT_TRUE(owners.insert(scene.Discs().owner[begin]).second);
  });
  return owners;
}

TEST(Scene, EveryDiscInReachIsVisitedOnce) {
  Random random(31);
  for (int round = 0; round < 100; ++round) {
    Scene scene({});
    std::vector<Vec2> centres;
    std::vector<double> radii;
    const double extent_m = random.Uniform(0.1, 60);
    for (Owner owner = 0; owner < 200; ++owner) {
      centres.push_back(Somewhere(&random, extent_m));
      radii.push_back(random.Uniform(0.01, 1));
      scene.AddDisc(centres[owner], radii[owner], owner);
    }
    scene.Index();
    const Vec2 centre = Somewhere(&random, 1.3 * extent_m);
    const double reach_m = random.Uniform(0, 8);
    std::set<Owner> expected;
    for (Owner owner = 0; owner < 200; ++owner) {
      if (Norm(centres[owner] - centre) - radii[owner] <= reach_m) expected.insert(owner);
    }
    EXPECT_THAT(DiscOwnersNear(scene, centre, reach_m), IsSupersetOf(expected));
  }
}

TEST(Scene, EveryWallInReachIsVisited) {
  Random random(32);
  for (int round = 0; round < 300; ++round) {
    const double extent_m = random.Uniform(0.1, 200);
    std::vector<Wall> walls(1 + random.Next() % 60);
    for (Wall& wall : walls) {
      wall.from_world = Somewhere(&random, extent_m);
      const Vec2 along = Somewhere(&random, random.Uniform(0, extent_m));
      // Many walls of real places run along an axis, or along the edge of a cell.
      const std::uint64_t kind = random.Next() % 4;
      wall.to_world = wall.from_world + Vec2{kind == 1 ? 0 : along.x, kind == 2 ? 0 : along.y};
    }
    const Scene scene(walls);
    for (int question = 0; question < 30; ++question) {
      const Vec2 centre = Somewhere(&random, 1.3 * extent_m);
      const double reach_m = random.Uniform(0, 8);
      std::set<std::uint32_t> visited;
      scene.WallsNear(centre, reach_m, [&](std::uint32_t wall) { visited.insert(wall); });
      for (std::uint32_t i = 0; i < walls.size(); ++i) {
        if (!Reaches(scene.Walls()[i], centre, reach_m)) continue;
        ASSERT_TRUE(visited.contains(i)) << i;
      }
    }
  }
}

TEST(Scene, OnlyAFewOfManyWallsAreVisited) {
  std::vector<Wall> walls;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec2 from = {2.0 * i, 2.0 * j};
      walls.push_back({from, from + Vec2{1, 0.5}});
    }
  }
  const Scene scene(walls);
  int visits = 0;
  scene.WallsNear({64, 64}, 5.3, [&](std::uint32_t) { ++visits; });
  EXPECT_LT(visits, 200);
}

TEST(Scene, ManyWallsOfGreatLengthSideBySideStayFewListEntries) {
  std::vector<Wall> walls(4096);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    walls[i] = {{0, 1e-3 * static_cast<double>(i)}, {1e6, 1e-3 * static_cast<double>(i)}};
  }
  const Scene scene(walls);
  std::size_t visits = 0;
  scene.WallsNear({5e5, 2}, 1e7, [&](std::uint32_t) { ++visits; });
  EXPECT_LT(visits, 20 * walls.size());
}

TEST(Scene, BoxSidesAndLeavesInReachAreVisitedWithTheirOwner) {
  Random random(33);
  for (int round = 0; round < 200; ++round) {
    Scene scene({});
    std::vector<SceneSegment> segments;
    for (Owner owner = 0; owner < 40; ++owner) {
      const Pose pose = {Somewhere(&random, 20), random.Uniform(-kPi, kPi)};
      const Vec2 half = {random.Uniform(0.01, 2), random.Uniform(0.01, 2)};
      scene.AddBox(pose, half, owner);
      const Vec2 corners[] = {ToWorld(pose, half), ToWorld(pose, {-half.x, half.y}),
                              ToWorld(pose, {-half.x, -half.y}), ToWorld(pose, {half.x, -half.y})};
      for (int i = 0; i < 4; ++i) segments.push_back({corners[i], corners[(i + 1) % 4], owner});
      const Vec2 from = Somewhere(&random, 20);
      segments.push_back({from, from + Somewhere(&random, 4), owner + 100});
      scene.AddSegment(segments.back().from_world, segments.back().to_world, owner + 100);
    }
    scene.Index();
    const Vec2 centre = Somewhere(&random, 22);
    std::multiset<Owner> expected;
    std::multiset<Owner> visited;
    for (const SceneSegment& segment : segments) {
      if (Reaches(segment, centre, 3)) expected.insert(segment.owner);
    }
    scene.SegmentsNear(centre, 3 + 1e-9, [&](const SceneSegment& segment) {
      if (Reaches(segment, centre, 3 + 1e-9)) visited.insert(segment.owner);
    });
    ASSERT_EQ(visited, expected);
  }
}

TEST(Scene, APointInABoxFindsItsOwnerUnlessThatIsItself) {
  Scene scene({});
  scene.AddBox({{3, 4}, kPi / 6}, {1, 0.5}, 7);
  scene.AddBox({{3, 4}, 0}, {0.1, 0.1}, 9);
  scene.Index();
  const Pose box = {{3, 4}, kPi / 6};
  EXPECT_EQ(scene.BoxAround(ToWorld(box, {0.999, 0.499}), 1), 7U);
  EXPECT_EQ(scene.BoxAround(ToWorld(box, {0.999, 0.501}), 1), kNoOwner);
  EXPECT_EQ(scene.BoxAround(ToWorld(box, {-1.001, 0}), 1), kNoOwner);
  EXPECT_EQ(scene.BoxAround({3, 4}, 1), 7U);
  EXPECT_EQ(scene.BoxAround({3, 4}, 7), 9U);
  EXPECT_EQ(scene.BoxAround({2.2, 3.6}, 7), kNoOwner);
}

TEST(Scene, ClearForgetsEverythingButTheWalls) {
  const Wall wall = {{0, 0}, {1, 0}};
  Scene scene({&wall, 1});
  scene.AddDisc({0, 0}, 1, 1);
  scene.AddBox({}, {1, 1}, 2);
  scene.AddSegment({0, 0}, {1, 1}, 3);
  scene.Index();
  scene.Clear();
  scene.Index();
  EXPECT_TRUE(DiscOwnersNear(scene, {0, 0}, 9).empty());
  std::vector<Owner> owners;
  scene.SegmentsNear({0, 0}, 9, [&](const SceneSegment& s) { owners.push_back(s.owner); });
  EXPECT_THAT(owners, testing::ElementsAre(kNoOwner));
  EXPECT_EQ(scene.BoxAround({0, 0}, 9), kNoOwner);
}

}  // namespace
}  // namespace giveway::sim

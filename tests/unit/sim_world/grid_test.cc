#include "sim_world/geometry/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "services/types/math/random.h"

namespace giveway::sim {
namespace {

std::vector<Vec2> Scatter(std::size_t count, double half_m, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec2> centres(count);
  for (Vec2& centre : centres) {
    centre = {random.Uniform(-half_m, half_m), random.Uniform(-half_m, half_m)};
  }
  return centres;
}

std::vector<std::uint32_t> Visited(const Grid& grid, Vec2 centre, double reach_m) {
  std::vector<std::uint32_t> visited;
  grid.Near(centre, reach_m, [&](std::uint32_t begin, std::uint32_t end) {
    for (; begin != end; ++begin) visited.push_back(grid.Order()[begin]);
  });
  return visited;
}

TEST(Grid, OrderIsAPermutation) {
  Grid grid;
  grid.Rebuild(Scatter(500, 20, 1), 1);
  std::vector<std::uint32_t> order(grid.Order().begin(), grid.Order().end());
  std::ranges::sort(order);
  for (std::uint32_t i = 0; i < 500; ++i) ASSERT_EQ(order[i], i);
}

// Everything within reach is visited, nothing twice, whatever the cell size, reach and place.
TEST(Grid, FindsWhatBruteForceFinds) {
  Random random(2);
  Grid grid;
  for (int round = 0; round < 300; ++round) {
    const auto count = static_cast<std::size_t>(random.Uniform(0, 200));
    const double half_m = random.Uniform(0.01, 50);
    const std::vector<Vec2> centres = Scatter(count, half_m, random.Next());
    grid.Rebuild(centres, random.Uniform(0.01, 10));
    const Vec2 at = {random.Uniform(-1.5, 1.5) * half_m, random.Uniform(-1.5, 1.5) * half_m};
    const double reach_m = random.Uniform(0, half_m);
    const std::vector<std::uint32_t> visited = Visited(grid, at, reach_m);
    const std::set<std::uint32_t> unique(visited.begin(), visited.end());
    ASSERT_EQ(unique.size(), visited.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec2 way = centres[i] - at;
      if (std::max(std::abs(way.x), std::abs(way.y)) <= reach_m) {
        ASSERT_TRUE(unique.contains(i)) << round;
      }
    }
  }
}

TEST(Grid, IndicesInACellAscend) {
  Grid grid;
  grid.Rebuild(std::vector<Vec2>(50, Vec2{3, 4}), 1);
  EXPECT_TRUE(std::ranges::is_sorted(grid.Order()));
}

// Two vehicles at the ends of the world must not cost a cell for every metre between them.
TEST(Grid, FarApartCentresCostFewCells) {
  Grid grid;
  const std::vector<Vec2> centres = {{-1e6, -1e6}, {1e6, 1e6}, {0, 0}};
  grid.Rebuild(centres, 0.5);
  int stretches = 0;
  grid.Near({0, 0}, 3e6, [&](std::uint32_t, std::uint32_t) { ++stretches; });
  EXPECT_LE(stretches, 3);
  EXPECT_EQ(Visited(grid, {1e6, 1e6}, 1), std::vector<std::uint32_t>{1});
}

TEST(Grid, AnEmptyGridFindsNothing) {
  Grid grid;
  grid.Rebuild({}, 1);
  EXPECT_TRUE(Visited(grid, {0, 0}, 10).empty());
  grid.Rebuild(Scatter(3, 1, 1), 1);
  grid.Rebuild({}, 1);
  EXPECT_TRUE(Visited(grid, {0, 0}, 10).empty());
}

}  // namespace
}  // namespace giveway::sim

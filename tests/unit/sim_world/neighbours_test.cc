#include "sim_world/geometry/neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "services/types/math/random.h"
#include "tests/unit/sim_world/cuts.h"

namespace giveway::sim {
namespace {

std::vector<Ball> Scatter(Random* random, std::uint32_t count) {
  std::vector<Ball> balls;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool large = random->Uniform(0, 1) < 0.1;
    balls.push_back({{random->Uniform(-10, 10), random->Uniform(-10, 10)},
                     large ? random->Uniform(1, 6) : random->Uniform(0.1, 0.5),
                     i});
  }
  return balls;
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Pair> Sorted(std::span<const NearPair> found) {
  std::vector<Pair> pairs;
  for (const NearPair& pair : found) pairs.emplace_back(pair.a, pair.b);
  std::ranges::sort(pairs);
  return pairs;
}

TEST(Neighbours, AreThoseBruteForceFinds) {
  Random random(5);
  Neighbours neighbours;
  for (std::uint32_t round = 0; round < 200; ++round) {
    const std::vector<Ball> balls = Scatter(&random, round % 150);
    const double margin_m = random.Uniform(0, 1) < 0.5 ? 1e-6 : random.Uniform(0, 3);
    std::vector<Pair> expected;
    for (std::uint32_t a = 0; a < balls.size(); ++a) {
      for (std::uint32_t b = 0; b < a; ++b) {
        const double apart_m = Norm(balls[a].centre_world - balls[b].centre_world) -
                               balls[a].reach_m - balls[b].reach_m;
        if (apart_m <= margin_m) expected.emplace_back(a, b);
      }
    }
    std::ranges::sort(expected);
    neighbours.Find(balls, margin_m, OnThisThread);
    ASSERT_EQ(Sorted(neighbours.Pairs()), expected) << round;
  }
}

TEST(Neighbours, ComeInTheSameOrderHoweverTheWorkIsCut) {
  Random random(6);
  const std::vector<Ball> balls = Scatter(&random, 400);
  Neighbours whole;
  whole.Find(balls, 0.5, OnThisThread);
  for (const std::size_t pieces : {3U, 7U}) {
    Neighbours cut;
    cut.Find(balls, 0.5, InPiecesFromTheBack(pieces));
    ASSERT_TRUE(std::ranges::equal(whole.Pairs(), cut.Pairs(), [](const auto& x, const auto& y) {
      return std::tie(x.a, x.b, x.apart_m) == std::tie(y.a, y.b, y.apart_m);
    }));
  }
}

}  // namespace
}  // namespace giveway::sim

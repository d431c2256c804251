// The broad phase of collision detection: pairs of things whose discs are near each other, found
// with a grid. The few that are much larger than a vehicle are searched from their own side, so
// that they do not widen the search of all others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/math/vec2.h"
#include "services/types/parallel.h"
#include "sim_world/geometry/grid.h"
#include "sim_world/geometry/parallel_collector.h"

namespace giveway::sim {

// The disc that a thing cannot leave within the tick.
struct Ball {
  Vec2 centre_world;
  double reach_m = 0;
  std::uint32_t thing = 0;  // the caller's numbering
};

struct NearPair {
  std::uint32_t a = 0;  // the higher number
  std::uint32_t b = 0;
  double apart_m = 0;  // between the balls; negative where they overlap
};

class Neighbours {
 public:
  // Finds all pairs of balls that are at most margin_m apart, each once, in an order that depends
  // on the balls alone. Every coordinate is finite.
  void Find(std::span<const Ball> balls, double margin_m, const ParallelFor& parallel);

  std::span<const NearPair> Pairs() const { return pairs_.All(); }

 private:
  void Sort(std::span<const Ball> balls);
  void PairSmall(std::size_t at, double margin_m, std::vector<NearPair>* pairs) const;
  void PairLarge(std::size_t at, double margin_m, std::vector<NearPair>* pairs) const;

  Grid grid_;
  std::vector<Ball> small_;  // in the order of the grid
  std::vector<Ball> large_;
  std::vector<Ball> unsorted_;
  std::vector<Vec2> centres_;
  double widest_m_ = 0;  // of small_
  ParallelCollector<NearPair> pairs_;
};

}  // namespace giveway::sim

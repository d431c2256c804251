// Which vehicle may be where and when: the ground in square tiles, time in steps, each tile booked
// for one vehicle at a time (Dresner and Stone, JAIR 31, 2008). Keeps the book; decides nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "services/types/math/vec2.h"

namespace giveway::bench {

using Tile = std::uint32_t;  // row by row from the low corner
using Step = std::uint32_t;  // of time, from the start on

struct Ground {
  Vec2 low_world;  // corners, m
  Vec2 high_world;
  double tile_m = 0.05;
};

class TileBook {
 public:
  explicit TileBook(const Ground& ground);

  // The tiles a disc touches, in order. Outside the ground there are none.
  void TilesUnder(Vec2 centre_world, double radius_m, std::vector<Tile>* tiles) const;

  bool IsTaken(Tile tile, Step step) const {
    if (step >= stood_from_[tile]) return true;
    return step < free_from_[tile] &&
           (taken_[step][tile / kWordBits] >> (tile % kWordBits) & 1U) != 0;
  }
  // At any time.
  bool IsEverTaken(Tile tile) const { return stood_from_[tile] != kNever || free_from_[tile] > 0; }
  // All of them, or none: false if one is taken.
  bool Book(std::span<const Tile> tiles, Step step);

  // For a vehicle that stands there from a step on, permanently. False, and books none, if one is
  // taken then or later.
  bool BookFrom(std::span<const Tile> tiles, Step step);
  // The vehicle that stood there gets a plan, and is there no longer than that says.
  void GiveBack(std::span<const Tile> tiles);
  // No vehicle will be there from the step on.
  bool IsFreeFrom(Tile tile, Step step) const;

 private:
  static constexpr Tile kWordBits = 64;
  static constexpr Step kNever = std::numeric_limits<Step>::max();

  Ground ground_;
  std::int32_t columns_;
  std::int32_t rows_;
  std::vector<std::vector<std::uint64_t>> taken_;  // [step][tile / 64]
  std::vector<Step> stood_from_;                   // by tile; kNever: none stands there
  std::vector<Step> free_from_;                    // by tile: after the last step booked
};

}  // namespace giveway::bench

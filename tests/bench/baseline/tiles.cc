#include "tests/bench/baseline/tiles.h"

#include <algorithm>
#include <cmath>

namespace giveway::bench {
namespace {

std::int32_t Cells(double length_m, double tile_m) {
  return std::max(1, static_cast<std::int32_t>(std::ceil(length_m / tile_m)));
}

std::int32_t CellOf(double offset_m, double tile_m) {
  return static_cast<std::int32_t>(std::floor(offset_m / tile_m));
}

double Outside(double at, double low, double high) { return std::max({0.0, low - at, at - high}); }

}  // namespace

TileBook::TileBook(const Ground& ground)
    : ground_(ground),
      columns_(Cells(ground.high_world.x - ground.low_world.x, ground.tile_m)),
      rows_(Cells(ground.high_world.y - ground.low_world.y, ground.tile_m)),
      stood_from_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNever),
      free_from_(stood_from_.size(), 0) {}

void TileBook::TilesUnder(Vec2 centre_world, double radius_m, std::vector<Tile>* tiles) const {
  tiles->clear();
  const double tile_m = ground_.tile_m;
  const Vec2 centre = centre_world - ground_.low_world;
  const std::int32_t first_row = std::max(0, CellOf(centre.y - radius_m, tile_m));
  const std::int32_t last_row = std::min(rows_ - 1, CellOf(centre.y + radius_m, tile_m));
  const std::int32_t first = std::max(0, CellOf(centre.x - radius_m, tile_m));
  const std::int32_t last = std::min(columns_ - 1, CellOf(centre.x + radius_m, tile_m));
  for (std::int32_t row = first_row; row <= last_row; ++row) {
    const double dy = Outside(centre.y, row * tile_m, (row + 1) * tile_m);
    for (std::int32_t column = first; column <= last; ++column) {
      const double dx = Outside(centre.x, column * tile_m, (column + 1) * tile_m);
      if (dx * dx + dy * dy > radius_m * radius_m) continue;
      tiles->push_back(static_cast<Tile>(row * columns_ + column));
    }
  }
}

bool TileBook::Book(std::span<const Tile> tiles, Step step) {
  if (std::ranges::any_of(tiles, [&](Tile tile) { return IsTaken(tile, step); })) return false;
  while (taken_.size() <= step) {
    taken_.emplace_back((stood_from_.size() + kWordBits - 1) / kWordBits, 0);
  }
  for (const Tile tile : tiles) {
    taken_[step][tile / kWordBits] |= std::uint64_t{1} << (tile % kWordBits);
    free_from_[tile] = std::max(free_from_[tile], step + 1);
  }
  return true;
}

bool TileBook::BookFrom(std::span<const Tile> tiles, Step step) {
  if (!std::ranges::all_of(tiles, [&](Tile tile) { return IsFreeFrom(tile, step); })) return false;
  for (const Tile tile : tiles) stood_from_[tile] = step;
  return true;
}

void TileBook::GiveBack(std::span<const Tile> tiles) {
  for (const Tile tile : tiles) stood_from_[tile] = kNever;
}

bool TileBook::IsFreeFrom(Tile tile, Step step) const {
  return stood_from_[tile] == kNever && step >= free_from_[tile];
}

}  // namespace giveway::bench

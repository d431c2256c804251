#include "sim_world/geometry/wall_grid.h"

#include <algorithm>
#include <cmath>

namespace giveway::sim {
namespace {

constexpr double kSmallestWallCell_m = 4;
constexpr double kCellsPerWall = 4;
constexpr double kEntriesPerWall = 24;
constexpr double kFewest = 1024;
// A wall is listed where it comes this near, as a share of the cell, so that rounding loses none.
constexpr double kMargin = 1e-6;

}  // namespace

WallGrid::WallGrid(std::span<const Wall> walls, double listed_reach_m)
    : listed_reach_m_(listed_reach_m) {
  if (walls.empty()) return;
  Span(walls);
  starts_.assign(columns_ * rows_ + 1, 0);
  for (const Wall& wall : walls) {
    CellsOf(wall, [&](std::size_t cell) { ++starts_[cell + 1]; });
  }
  for (std::size_t cell = 0; cell + 1 < starts_.size(); ++cell) starts_[cell + 1] += starts_[cell];
  walls_.resize(starts_.back());
  std::vector<std::uint32_t> next = starts_;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    CellsOf(walls[i],
            [&](std::size_t cell) { walls_[next[cell]++] = static_cast<std::uint32_t>(i); });
  }
}

std::size_t WallGrid::Cell(double offset_m, std::size_t count) const {
  const double cell = offset_m / cell_m_;
  if (!(cell > 0)) return 0;
  const double last = static_cast<double>(count - 1);
  return cell < last ? static_cast<std::size_t>(cell) : count - 1;
}

// Neither a wide place with few walls nor long walls side by side may cost a huge table.
void WallGrid::Span(std::span<const Wall> walls) {
  low_ = walls.front().from_world;
  high_ = low_;
  double length_m = 0;
  for (const Wall& wall : walls) {
    for (const Vec2 end : {wall.from_world, wall.to_world}) {
      low_ = {std::min(low_.x, end.x), std::min(low_.y, end.y)};
      high_ = {std::max(high_.x, end.x), std::max(high_.y, end.y)};
    }
    length_m += Norm(wall.to_world - wall.from_world);
  }
  if (listed_reach_m_ > 0) {
    const double margin_m = listed_reach_m_ + kMargin * kSmallestWallCell_m;
    low_ = low_ - Vec2{margin_m, margin_m};
    high_ = high_ + Vec2{margin_m, margin_m};
  }
  const auto count = static_cast<double>(walls.size());
  const auto cells = [&](double extent_m) { return std::floor(extent_m / cell_m_) + 1; };
  const Vec2 extent = high_ - low_;
  const auto too_many = [&] {
    const double across = 1 + 2 * listed_reach_m_ / cell_m_;  // cells a point is listed in, a row
    const double entries = across * (across * count + length_m / cell_m_);
    return cells(extent.x) * cells(extent.y) > kFewest + kCellsPerWall * count ||
           entries > kFewest + kEntriesPerWall * count;
  };
  cell_m_ = kSmallestWallCell_m;
  while (too_many()) cell_m_ *= 2;
  columns_ = static_cast<std::size_t>(cells(extent.x));
  rows_ = static_cast<std::size_t>(cells(extent.y));
}

// Row by row: the columns over which the wall crosses the row's band.
template <typename Visit>
void WallGrid::CellsOf(const Wall& wall, const Visit& visit) const {
  const bool rises = wall.from_world.y <= wall.to_world.y;
  const Vec2 from = rises ? wall.from_world : wall.to_world;
  const Vec2 along = (rises ? wall.to_world : wall.from_world) - from;
  const double margin_m = listed_reach_m_ + kMargin * cell_m_;
  const auto x_at = [&](double y) {
    return along.y > 0 ? from.x + std::clamp((y - from.y) / along.y, 0.0, 1.0) * along.x : from.x;
  };
  const std::size_t top = Row(from.y + along.y + margin_m);
  for (std::size_t row = Row(from.y - margin_m); row <= top; ++row) {
    const double band_m = low_.y + static_cast<double>(row) * cell_m_;
    const bool flat = along.y <= 2 * margin_m;  // within one band, give or take the margin
    const double x1 = flat ? from.x : x_at(band_m - margin_m);
    const double x2 = flat ? from.x + along.x : x_at(band_m + cell_m_ + margin_m);
    const std::size_t right = Column(std::max(x1, x2) + margin_m);
    for (std::size_t column = Column(std::min(x1, x2) - margin_m); column <= right; ++column) {
      visit(row * columns_ + column);
    }
  }
}

}  // namespace giveway::sim

#include "sim_world/geometry/grid.h"

#include <algorithm>
#include <cmath>

namespace giveway::sim {
namespace {

constexpr std::size_t kCellsPerCentre = 4;
constexpr std::size_t kFewestCells = 64;

}  // namespace

std::size_t Grid::Cell(double offset_m, std::size_t count) const {
  const double cell = offset_m * per_cell_m_;
  if (!(cell > 0)) return 0;
  const double last = static_cast<double>(count - 1);
  return cell < last ? static_cast<std::size_t>(cell) : count - 1;
}

// A few vehicles far apart must not cost a huge table: the cells grow until they are few enough.
void Grid::Span(std::span<const Vec2> centres, double cell_m) {
  Vec2 high = centres.front();
  low_ = high;
  for (const Vec2 centre : centres) {
    low_ = {std::min(low_.x, centre.x), std::min(low_.y, centre.y)};
    high = {std::max(high.x, centre.x), std::max(high.y, centre.y)};
  }
  const double most = static_cast<double>(kFewestCells + kCellsPerCentre * centres.size());
  double width = std::floor((high.x - low_.x) / cell_m) + 1;
  double height = std::floor((high.y - low_.y) / cell_m) + 1;
  while (width * height > most) {
    cell_m *= 2;
    width = std::floor((high.x - low_.x) / cell_m) + 1;
    height = std::floor((high.y - low_.y) / cell_m) + 1;
  }
  per_cell_m_ = 1 / cell_m;
  columns_ = static_cast<std::size_t>(width);
  rows_ = static_cast<std::size_t>(height);
}

void Grid::Rebuild(std::span<const Vec2> centres, double cell_m) {
  order_.resize(centres.size());
  if (centres.empty()) return;
  Span(centres, cell_m);
  cells_.resize(centres.size());
  starts_.assign(columns_ * rows_ + 1, 0);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const std::size_t cell = Row(centres[i].y) * columns_ + Column(centres[i].x);
    cells_[i] = static_cast<std::uint32_t>(cell);
    ++starts_[cell + 1];
  }
  for (std::size_t cell = 0; cell + 1 < starts_.size(); ++cell) starts_[cell + 1] += starts_[cell];
  // Filled from the back, so that starts_ ends up as the start of each cell again.
  for (std::size_t i = centres.size(); i-- > 0;) {
    order_[--starts_[cells_[i] + 1]] = static_cast<std::uint32_t>(i);
  }
  // Every entry after the first now holds the start of the cell before it.
  std::rotate(starts_.begin(), starts_.begin() + 1, starts_.end());
  starts_.back() = static_cast<std::uint32_t>(centres.size());
}

}  // namespace giveway::sim

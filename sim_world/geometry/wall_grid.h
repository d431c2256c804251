// Which walls are near: every wall listed in each square cell that it passes within a reach of,
// built once. Knows indices only. With a reach, one cell's list answers for any point in the cell;
// without, a search may ask for any distance, and may name a long wall more than once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

class WallGrid {
 public:
  // Within listed_reach_m along either axis, that is.
  explicit WallGrid(std::span<const Wall> walls, double listed_reach_m = 0);

  // Each wall within the listed reach of `point`, and others near them, once.
  std::span<const std::uint32_t> At(Vec2 point) const {
    const bool outside = point.x < low_.x || point.x > high_.x || point.y < low_.y ||
                         point.y > high_.y || walls_.empty();
    if (outside) return {};
    const std::size_t cell = Row(point.y) * columns_ + Column(point.x);
    return std::span(walls_).subspan(starts_[cell], starts_[cell + 1] - starts_[cell]);
  }

  // Calls visit(index) for every wall within reach_m of `centre` along either axis, and others
  // near them; row by row, so always in the same order.
  template <typename Visit>
  void Near(Vec2 centre, double reach_m, Visit&& visit) const {
    if (walls_.empty()) return;
    const std::size_t left = Column(centre.x - reach_m);
    const std::size_t right = Column(centre.x + reach_m);
    const std::size_t top = Row(centre.y + reach_m);
    for (std::size_t row = Row(centre.y - reach_m); row <= top; ++row) {
      const std::uint32_t end = starts_[row * columns_ + right + 1];
      for (std::uint32_t i = starts_[row * columns_ + left]; i != end; ++i) visit(walls_[i]);
    }
  }

 private:
  std::size_t Column(double x) const { return Cell(x - low_.x, columns_); }
  std::size_t Row(double y) const { return Cell(y - low_.y, rows_); }
  std::size_t Cell(double offset_m, std::size_t count) const;
  void Span(std::span<const Wall> walls);
  template <typename Visit>
  void CellsOf(const Wall& wall, const Visit& visit) const;

  double listed_reach_m_;
  Vec2 low_;  // further than the listed reach from any wall; so is high_
  Vec2 high_;
  double cell_m_ = 1;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::uint32_t> starts_;  // of each cell in walls_, and one more
  std::vector<std::uint32_t> walls_;   // indices, cell by cell
};

}  // namespace giveway::sim

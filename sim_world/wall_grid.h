// Which walls are near: every wall listed in each square cell it passes through, built once.
// Knows indices only. A long wall lies in many cells, so a search may name it more than once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

class WallGrid {
 public:
  explicit WallGrid(std::span<const Wall> walls);

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

  Vec2 low_;
  double cell_m_ = 1;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::uint32_t> starts_;  // of each cell in walls_, and one more
  std::vector<std::uint32_t> walls_;   // indices, cell by cell
};

}  // namespace giveway::sim

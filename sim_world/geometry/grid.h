// A uniform grid over discs, rebuilt each time by counting sort, to find what is near. Knows
// centres and indices, no bodies. Rebuilding allocates nothing once the grid has grown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/math/vec2.h"

namespace giveway::sim {

class Grid {
 public:
  // Sorts the centres into square cells of at least cell_m a side (wider where the area would need
  // more than a few cells a centre). Every coordinate is finite.
  void Rebuild(std::span<const Vec2> centres, double cell_m);

  // The indices given to Rebuild, cell by cell, a row of cells lying together; within a cell they
  // ascend, so that the same centres give the same order.
  std::span<const std::uint32_t> Order() const { return order_; }

  // Calls visit(start, end) with stretches of Order() that together hold every centre within
  // reach_m of `centre`, along either axis, and others near them. One stretch a row, in order.
  template <typename Visit>
  void Near(Vec2 centre, double reach_m, Visit&& visit) const {
    if (order_.empty()) return;
    const std::size_t left = Column(centre.x - reach_m);
    const std::size_t right = Column(centre.x + reach_m);
    const std::size_t top = Row(centre.y + reach_m);
    for (std::size_t row = Row(centre.y - reach_m); row <= top; ++row) {
      const std::uint32_t begin = starts_[row * columns_ + left];
      const std::uint32_t end = starts_[row * columns_ + right + 1];
      if (begin != end) visit(begin, end);
    }
  }

 private:
  std::size_t Column(double x) const { return Cell(x - low_.x, columns_); }
  std::size_t Row(double y) const { return Cell(y - low_.y, rows_); }
  std::size_t Cell(double offset_m, std::size_t count) const;
  void Span(std::span<const Vec2> centres, double cell_m);

  Vec2 low_;
  double per_cell_m_ = 1;  // cells a metre
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::uint32_t> cells_;   // of each centre
  std::vector<std::uint32_t> starts_;  // of each cell in order_, and one more
  std::vector<std::uint32_t> order_;
};

}  // namespace giveway::sim

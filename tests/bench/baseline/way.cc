#include "tests/bench/baseline/way.h"

#include <algorithm>

namespace giveway::bench {

void Way::Add(double length_m, double bend_per_m) {
  pieces_.push_back({end_, length_m, bend_per_m});
  end_ = AdvanceArc(end_, {.forward_m_s = 1, .turn_rad_s = bend_per_m}, length_m);
  length_m_ += length_m;
}

const WayPiece* Way::PieceAt(double* driven_m) const {
  for (const WayPiece& piece : pieces_) {
    if (*driven_m <= piece.length_m || &piece == &pieces_.back()) return &piece;
    *driven_m -= piece.length_m;
  }
  return nullptr;
}

Pose Way::PoseAt(double driven_m) const {
  double on_piece_m = std::clamp(driven_m, 0.0, length_m_);
  const WayPiece* piece = PieceAt(&on_piece_m);
  if (piece == nullptr) return end_;
  return AdvanceArc(piece->world_from_start, {.forward_m_s = 1, .turn_rad_s = piece->bend_per_m},
                    on_piece_m);
}

double Way::BendAt(double driven_m) const {
  double on_piece_m = std::clamp(driven_m, 0.0, length_m_);
  const WayPiece* piece = PieceAt(&on_piece_m);
  return piece == nullptr ? 0 : piece->bend_per_m;
}

Way StraightWay(const Pose& world_from_start, double length_m) {
  Way way(world_from_start);
  way.Add(length_m, 0);
  return way;
}

}  // namespace giveway::bench

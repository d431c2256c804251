#include "tests/bench/baseline/arc_path.h"

#include <algorithm>

namespace giveway::bench {

void ArcPath::Add(double length_m, double bend_per_m) {
  pieces_.push_back({end_, length_m, bend_per_m});
  end_ = AdvanceArc(end_, {.forward_m_s = 1, .turn_rad_s = bend_per_m}, length_m);
  length_m_ += length_m;
}

const PathArc* ArcPath::PieceAt(double* driven_m) const {
  for (const PathArc& piece : pieces_) {
    if (*driven_m <= piece.length_m || &piece == &pieces_.back()) return &piece;
    *driven_m -= piece.length_m;
  }
  return nullptr;
}

Pose ArcPath::PoseAt(double driven_m) const {
  double on_piece_m = std::clamp(driven_m, 0.0, length_m_);
  const PathArc* piece = PieceAt(&on_piece_m);
  if (piece == nullptr) return end_;
  return AdvanceArc(piece->world_from_start, {.forward_m_s = 1, .turn_rad_s = piece->bend_per_m},
                    on_piece_m);
}

double ArcPath::BendAt(double driven_m) const {
  double on_piece_m = std::clamp(driven_m, 0.0, length_m_);
  const PathArc* piece = PieceAt(&on_piece_m);
  return piece == nullptr ? 0 : piece->bend_per_m;
}

ArcPath StraightPath(const Pose& world_from_start, double length_m) {
  ArcPath path(world_from_start);
  path.Add(length_m, 0);
  return path;
}

}  // namespace giveway::bench

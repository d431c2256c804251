// A path along the ground, of straight pieces and arcs, given by the distance driven. No speeds.
#pragma once

#include <vector>

#include "services/types/math/pose.h"

namespace giveway::bench {

struct PathArc {
  Pose world_from_start;
  double length_m = 0;
  double bend_per_m = 0;  // heading change a metre, counter-clockwise; 0: straight
};

class ArcPath {
 public:
  // Each Add continues from the end so far, the first one from the start.
  explicit ArcPath(const Pose& world_from_start) : end_(world_from_start) {}
  void Add(double length_m, double bend_per_m);

  double Length_m() const { return length_m_; }
  // Before the start and beyond the end: the nearest.
  Pose PoseAt(double driven_m) const;
  double BendAt(double driven_m) const;

 private:
  const PathArc* PieceAt(double* driven_m) const;

  std::vector<PathArc> pieces_;
  Pose end_;
  double length_m_ = 0;
};

// Straight on from the pose.
ArcPath StraightPath(const Pose& world_from_start, double length_m);

}  // namespace giveway::bench

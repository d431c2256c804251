// Contact and closest approach of outlines that move and turn: boxes, and whatever meets a sliding
// leaf. approach.cc chooses between this and the shorter paths of discs.
#pragma once

#include <optional>

#include "sim_world/geometry/motion.h"

namespace giveway::sim {

// As FirstContact in approach.h, for shapes of any kind.
std::optional<double> FirstOutlineContact(const Motion& a, const Motion& b, double from_s,
                                          double to_s);
std::optional<double> FirstOutlineContact(const Motion& a, const Leaf& leaf, double from_s,
                                          double to_s);

struct ClosestMoment {
  double gap_m = 0;  // shell to shell
  double t_s = 0;
};

// The smaller of `smallest` and the smallest gap in [from_s, to_s], in which neither starts nor
// stops; to within kTouch_m.
ClosestMoment SmallerGap(const Motion& a, const Motion& b, double from_s, double to_s,
                         const ClosestMoment& smallest);

}  // namespace giveway::sim

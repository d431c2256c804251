// A door: a leaf that slides into its jamb and out again, by the time since the start signal. An
// obstruction stops it; once clear, it catches up with its schedule at its own speed.
#pragma once

#include "services/types/scenario.h"
#include "sim_world/geometry/motion.h"

namespace giveway::sim {

class SlidingDoor {
 public:
  explicit SlidingDoor(const Door& door);

  // The leaf's motion in the tick of dt_s that ends end_s after the start signal. Standing unless
  // `moving`.
  Leaf Plan(bool moving, double end_s, double dt_s) const;
  // Applies the outcome of the planned motion.
  void Settle(const Leaf& leaf, double dt_s);

  // The scheduled opening, whatever obstructs the leaf; as Opening.
  double PlannedOpening(double time_s) const;

  // The share of the leaf that is in the jamb: 0 closed, 1 open. Fully open, it obstructs no
  // vehicle.
  double Opening() const { return opening_; }
  void Restore(double opening) { opening_ = opening; }

 private:
  Door door_;
  double opening_;
};

}  // namespace giveway::sim

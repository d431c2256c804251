#include "sim_world/dynamics/doors.h"

#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"

namespace giveway::sim {

SlidingDoor::SlidingDoor(const Door& door) : door_(door), opening_(PlannedOpening(0)) {}

double SlidingDoor::PlannedOpening(double time_s) const {
  const double cycle_s = door_.closed_s + door_.open_s + 2 * door_.move_s;
  if (cycle_s <= 0) return 0;
  const double since_s = time_s + door_.offset_s;
  const double opening_s = since_s - std::floor(since_s / cycle_s) * cycle_s - door_.closed_s;
  if (opening_s <= 0) return 0;
  if (opening_s < door_.move_s) return opening_s / door_.move_s;
  const double closing_s = opening_s - door_.move_s - door_.open_s;
  if (closing_s <= 0) return 1;
  return closing_s < door_.move_s ? 1 - closing_s / door_.move_s : 0;
}

Leaf SlidingDoor::Plan(bool moving, double end_s, double dt_s) const {
  const Vec2 whole = door_.to_world - door_.from_world;
  Leaf leaf{.from_world = door_.from_world,
            .to_world = door_.from_world + (1 - opening_) * whole,
            .stop_s = dt_s};
  if (!moving) return leaf;
  const double most = door_.move_s > dt_s ? dt_s / door_.move_s : 1;
  const double change = std::clamp(PlannedOpening(end_s) - opening_, -most, most);
  leaf.to_velocity_world = -change / dt_s * whole;
  return leaf;
}

void SlidingDoor::Settle(const Leaf& leaf, double dt_s) {
  if (!Moves(leaf)) return;
  const Vec2 whole = door_.to_world - door_.from_world;
  const double drawn_in = 1 - Dot(TipAt(leaf, dt_s) - door_.from_world, whole) / SquaredNorm(whole);
  opening_ = std::clamp(drawn_in, 0.0, 1.0);
}

}  // namespace giveway::sim

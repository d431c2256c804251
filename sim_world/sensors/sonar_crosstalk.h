// Pulses that reach other vehicles directly. A listening transducer takes another's pulse, fired in
// the same slot, for its own echo: the pulse has travelled the distance once instead of out and
// back, so the transducer reads half of it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "services/types/math/pose.h"
#include "sim_world/geometry/grid.h"
#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sonar_ring.h"
#include "sim_world/sensors/sonar_schedule.h"

namespace giveway::sim {

// A transducer that fires in this slot, in the world frame.
struct Pulse {
  bool fired = false;  // false: switched off
  Vec2 apex_world;
  Vec2 axis_world;
  double cos_half = 1;
  double max_range_m = 0;
};
using Pulses = std::array<Pulse, kArrayCount>;

// Those of one vehicle.
Pulses PulsesOf(const SonarRing& ring, const Pose& world_from_body,
                const std::array<std::size_t, kArrayCount>& transducers);

// What `listener` reads of `talker`'s pulse: half the distance if each lies in the directions of
// the other's cone and the reading in the listener's range; kSilence_m otherwise. Occlusion is
// ignored.
double CrosstalkRange(const Pulse& listener, const Pulse& talker);

// All pulses of one slot.
class Crosstalk {
 public:
  void Clear();
  void Add(Owner owner, Vec2 position_world, const Pulses& pulses);
  // Call after the last Add and before the first query.
  void Index();

  // The nearest reading that comes from another vehicle's pulse; kSilence_m without one. `i` counts
  // the vehicles as they were added.
  double Nearest(const Scene& scene, std::size_t i, std::size_t array) const;

 private:
  std::vector<Owner> owners_;
  std::vector<Vec2> positions_world_;
  std::vector<Pulses> pulses_;
  double farthest_m_ = 0;  // between the positions of two that hear each other
  Grid grid_;
};

}  // namespace giveway::sim

// The earliest a vehicle can pass along a given path that is taken in places and at times: a search
// over all accelerations and decelerations that its drive allows, in steps of time and of speed.
// Exact on that lattice. Knows nothing of ground, tiles and other vehicles.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "services/types/vehicle_options.h"

namespace giveway::bench {

inline constexpr std::uint32_t kTicksAStep = 3;

// The lattice: speeds are levels, places are units of the distance driven. A level is gained in one
// step at no more than the drive's acceleration, and the last level is the cruise speed.
struct Pace {
  std::uint32_t top = 1;   // level at cruise speed
  std::uint32_t down = 2;  // levels that can be lost in a step
  double level_m_s = 0;
  double unit_m = 0;

  // Units driven in a step that starts at one level and ends at another: speed changes tick by
  // tick, and the world moves by the speed at the end of a tick.
  std::uint32_t Units(std::uint32_t from, std::uint32_t to) const;
  std::uint32_t UnitsAtMost() const { return Units(top, top); }
};
Pace PaceOf(const VehicleOptions& options);

// A bit a unit: 1 where the vehicle may be during the step.
using FreeUnits = std::vector<std::uint64_t>;

struct Passing {
  std::uint32_t first_step = 0;   // stands until the end of that step
  std::uint32_t arrive_unit = 0;  // there is the goal; then it brakes
  std::uint32_t last_unit = 0;    // as far as braking may take it
  std::uint32_t last_step = 0;    // gives up then
  // Of a step, from 1 on. Stretches taken are at least Pace::UnitsAtMost() long, so that nothing
  // jumps one within a step.
  std::function<const FreeUnits&(std::uint32_t step)> free_during;
  // True if the place stays free from the end of that step on.
  std::function<bool(std::uint32_t unit, std::uint32_t step)> may_stay;
};

struct Passage {
  std::vector<std::uint32_t> levels;  // at the end of each step; [0] is the start, at rest
  std::vector<std::uint32_t> units;   // the same for places
  std::uint32_t arrival_step = 0;     // levels continue until the vehicle stands
};

// Starts at unit 0 at rest. None if there is no passage in time.
std::optional<Passage> SoonestPassage(const Pace& pace, const Passing& passing);

}  // namespace giveway::bench

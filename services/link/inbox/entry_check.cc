#include "services/link/inbox/entry_check.h"

#include <limits>

#include "services/link/inbox/field_ranges.h"

namespace giveway::link {

std::optional<FieldFault> FaultOf(const RosterEntry& entry, VehicleId own) {
  constexpr double kMostId = std::numeric_limits<std::uint32_t>::max();
  FieldRanges ranges;
  ranges.Hold("world_epoch", Number(entry.epoch), 1, kMostId);
  if (!entry.accepted) return ranges.Fault();  // of a refusal the rest says nothing
  const double id = Number(own);
  if (own == kNoVehicle) {
    ranges.Hold("vehicle", Number(entry.vehicle), 1, kMostId);
  } else {
    ranges.Hold("vehicle", Number(entry.vehicle), id, id);
  }
  ranges.HoldPlace("start_world.x_m", entry.start_world.position_world.x);
  ranges.HoldPlace("start_world.y_m", entry.start_world.position_world.y);
  ranges.HoldBearing("start_world.heading_rad", entry.start_world.heading_rad);
  ranges.HoldCounted("counted_left_rad", entry.counted.left_rad);
  ranges.HoldCounted("counted_right_rad", entry.counted.right_rad);
  return ranges.Fault();
}

}  // namespace giveway::link

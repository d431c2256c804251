// Decisions as lines of tab-separated values, one per vehicle and tick, for both virtual runs and
// replays.
#pragma once

#include <string>
#include <string_view>

#include "services/types/vehicle_io.h"

namespace giveway::fleetctl {

inline constexpr std::string_view kTraceHead =
    "tick\ttime_s\tvehicle\tx_m\ty_m\theading_rad\tforward_m_s\tmode\trule\tpeer\tsensor\t"
    "gives_way_to\tblocked_by\twaited_ticks\torder_of\ttoward_x_m\ttoward_y_m\tarrived\n";

struct TraceLine {
  Tick tick = kNoTick;
  double time_s = 0;
  VehicleId vehicle = kNoVehicle;
  Pose world_from_body;  // the truth, or the vehicle's estimate where there is none
  double forward_m_s = 0;
  bool arrived = false;
};

void AppendLine(const TraceLine& line, const Outputs& said, std::string* text);

}  // namespace giveway::fleetctl

// How soon a profile set and a vehicle promise to notice a silent peer, as the library resolves the
// set. Creates no participant.
#pragma once

#include <cstdint>
#include <string>

#include "services/fleetctl/stopwatch/stopwatch_table.h"
#include "services/types/vehicle_options.h"

namespace giveway::fleetctl {

// `participants` is how many the fleet may have: above 32 the code sets another lease. Throws
// LinkError.
Limits ReadLimits(const std::string& qos_file, const std::string& interface,
                  std::uint32_t participants, const VehicleOptions& vehicle);

}  // namespace giveway::fleetctl

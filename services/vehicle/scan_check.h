// Whether a scan can be what this vehicle sensed, before anything is concluded from it.
#pragma once

#include "services/types/range_scan.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// True if every number is finite and can come from this vehicle's wheels and ultrasonics, and no
// reading is newer than the scan.
bool IsBelievable(const RangeScan& scan, const VehicleOptions& options);

}  // namespace giveway

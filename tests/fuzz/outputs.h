// What must hold of anything a brain says, whatever it was told.
#pragma once

#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"

namespace giveway::fuzz {

// Finite numbers, and wheels within what the profile or the weights allow.
void CheckOutputs(const Outputs& outputs, const VehicleOptions& options);

}  // namespace giveway::fuzz

// What must hold of the outputs of a brain, for any inputs.
#pragma once

#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"

namespace giveway::fuzz {

// Finite numbers, and wheels within what the profile or the weights allow.
void CheckOutputs(const Outputs& outputs, const VehicleOptions& options);

}  // namespace giveway::fuzz

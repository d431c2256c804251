// Why the brain refused a beacon, in words: for the log.
#pragma once

#include "services/types/refusal.h"
#include "services/vehicle/vehicle.h"

namespace giveway {

// `state` is that after the step which refused it.
Refusal Explain(const ReceivedBeacon& received, BeaconRefusal why, const VehicleState& state);

}  // namespace giveway

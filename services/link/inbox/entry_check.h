// Whether an entry of the roster can be believed, before anything is concluded from it. Pure.
#pragma once

#include <optional>

#include "services/types/fleet_facts.h"
#include "services/types/refusal.h"

namespace giveway::link {

// The first field that is not finite, not in range, or not meant for the vehicle `own`; nothing if
// the entry is sound. `own`: kNoVehicle before the vehicle has an id, then any will do.
std::optional<FieldFault> FaultOf(const RosterEntry& entry, VehicleId own);

}  // namespace giveway::link

// Where a brain takes itself to be as it begins, in a world or in the next one: as the world says,
// or as the process before it knew.
#pragma once

#include <optional>

#include "services/types/handover.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// What was seen, heard and waited for belongs to the world before, and is forgotten.
void EnterWorld(WorldEpoch epoch, const Pose& world_from_body, const VehicleOptions& options,
                VehicleState* state);

// Only the first entry of an epoch says something new: later ones are repeated, or tell of the run.
void TakeRoster(const RosterEntry& entry, const VehicleOptions& options, VehicleState* state);

// What the next process of this vehicle continues from; nothing before it was placed.
std::optional<Handover> HandoverOf(const VehicleState& state);

// Continues where the process before stopped. False, and nothing is done, where a handover is not
// sound.
bool TakeOver(const Handover& handover, const VehicleOptions& options, VehicleState* state);

}  // namespace giveway

// The pose a brain starts from, in its first world or in the next: as the world assigns it, or as
// handed over by the process before.
#pragma once

#include <optional>

#include "services/types/handover.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// What was seen, heard and waited for belongs to the world before, and is forgotten.
void EnterWorld(WorldEpoch epoch, const Pose& world_from_body, const VehicleOptions& options,
                VehicleState* state);

// Only the first entry of an epoch says something new: later ones repeat it, or report the run
// state.
void TakeRoster(const RosterEntry& entry, const VehicleOptions& options, VehicleState* state);

// What the next process of this vehicle continues from; nothing before it was placed.
std::optional<Handover> HandoverOf(const VehicleState& state);

// Continues where the process before stopped. False, and nothing is done, where a handover is not
// sound.
bool TakeOver(const Handover& handover, const VehicleOptions& options, VehicleState* state);

}  // namespace giveway

// How waiting moves a vehicle up in the order, and when it is forgotten.
#pragma once

#include "services/types/vehicle_options.h"
#include "services/vehicle/situation/situation.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// The waiting time that gives it priority: whole ageing limits only, so that this rarely changes,
// and two that wait for each other need not receive every tick.
std::uint32_t AgedTicks(const Waiting& state, const VehicleOptions& options);

// Moves its place in the order on by one step; `waits`: it stands to give way.
void KeepOrder(const OwnView& own, const Encounters& s, bool waits, Waiting* waiting);

}  // namespace giveway

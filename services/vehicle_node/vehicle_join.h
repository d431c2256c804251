// How a vehicle gets its first place, and by what it drives there.
#pragma once

#include <optional>
#include <string>

#include "services/link/vehicle_link.h"
#include "services/runtime/clock.h"
#include "services/runtime/process.h"
#include "services/types/scenario.h"
#include "services/vehicle_node/vehicle_health.h"

namespace giveway {

// By what the vehicle of this entry drives, from where it was put. Throws LinkError where the world
// has another scenario.
VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry);

// Why the vehicle `own` cannot be where the entry says: the scenario has no such place, or it is
// far from all the scenario has; empty if it can.
std::string WhyNoPlace(const Scenario& scenario, const RosterEntry& entry, VehicleId own);

// Asks, as `session` if the process had one before, and waits for the last word; a refusal is
// logged. Empty if asked to stop meanwhile.
std::optional<RosterEntry> Join(link::VehicleLink* link, Clock* clock, const StopSignal& stop,
                                VehicleId wanted, const std::optional<SessionId>& session,
                                VehicleHealthTeller* health);

}  // namespace giveway

// How a vehicle gets its first place, and by what it drives there.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "services/link/drive_link.h"
#include "services/runtime/clock.h"
#include "services/types/refusal.h"
#include "services/types/scenario.h"
#include "services/vehicle_node/vehicle_health.h"

namespace giveway {

// By what the vehicle of this entry drives, from where it was put. Throws LinkError where the world
// has another scenario.
VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry);

// Why the vehicle `own` (kNoVehicle: any) cannot be where the entry says: the scenario has no such
// place, or it is far from all the scenario has; empty if it can, or where the entry gives none.
std::string WhyNoPlace(const Scenario& scenario, const RosterEntry& entry, VehicleId own);
// Of an entry that is not followed for that.
Refusal RefusalOf(const RosterEntry& entry, const std::string& why);

struct JoinParts {
  link::DriveLink* link = nullptr;
  Clock* clock = nullptr;
  VehicleHealthReporter* health = nullptr;
  const Scenario* scenario = nullptr;
};

// Asks, as `session` if the process had one before, and waits for the last word; a refusal is
// logged. A place that cannot be is logged and not taken, and asked for again. Empty if asked to
// stop meanwhile. Throws LinkError where the world has another scenario.
std::optional<RosterEntry> Join(const JoinParts& parts, const std::function<bool()>& is_stopped,
                                VehicleId wanted, const std::optional<SessionId>& session);

}  // namespace giveway

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
// place, or it is far from all the scenario has and drives to a goal or in a loop; empty if it can,
// or where the entry gives none.
std::string WhyNoPlace(const Scenario& scenario, const RosterEntry& entry, VehicleId own);
// Of an entry that is not followed for that.
Refusal RefusalOf(const RosterEntry& entry, const std::string& why);

struct JoinParts {
  link::DriveLink* link = nullptr;
  Clock* clock = nullptr;
  VehicleHealthReporter* health = nullptr;
  const Scenario* scenario = nullptr;
};

struct JoinEnd {
  std::optional<RosterEntry> entry;  // empty: it was asked to stop, or hears no more
  // Its network interface is another: it is to be started again, and the log says why.
  bool interface_lost = false;
};

// Asks, as `session` if the process had one before, and waits for the last word; a refusal is
// logged. A place that cannot be is logged and not taken, and asked for again. Throws LinkError
// where the world has another scenario.
JoinEnd Join(const JoinParts& parts, const std::function<bool()>& is_stopped, VehicleId wanted,
             const std::optional<SessionId>& session);

}  // namespace giveway

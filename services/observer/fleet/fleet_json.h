// A fleet for programs: every field in the names of fleet.idl. Pure.
#pragma once

#include <optional>
#include <string>

#include "services/observer/fleet/fleet_view.h"
#include "services/types/time.h"

namespace giveway {

// {"world":{…},"vehicles":[{"vehicle":…,"hearing":…,"mode":…,…},…]}: a line a vehicle.
std::string FleetJson(const FleetView& view, SteadyTime now);
// Beacon, status, truth and ranges of one, each as its topic has it; nothing if it is not known.
std::optional<std::string> VehicleJson(const FleetView& view, VehicleId vehicle, SteadyTime now);
// {"events":[…]}: the last FleetView::kMostEvents at most.
std::string EventsJson(const FleetView& view);

}  // namespace giveway

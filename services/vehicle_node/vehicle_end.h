// What becomes of a vehicle's process once its loop has ended.
#pragma once

#include "services/node/service_admin.h"
#include "services/node/service_run.h"
#include "services/vehicle_node/vehicle_loop.h"

namespace giveway {

// Where it restarts it comes back as the same vehicle, with the profiles of the order.
LifeEnd EndOf(DriveEnd end, const VehicleLoop& loop, const ServiceAdmin& admin);

}  // namespace giveway

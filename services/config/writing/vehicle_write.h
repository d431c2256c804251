// A vehicle of a scenario, or one that comes to a spawn place, as the file holds it: the reverse of
// vehicle_read.h and pose_read.h.
#pragma once

#include "services/types/vehicle_options.h"

namespace giveway::schema {
class Spawn;
class Vehicle;
}  // namespace giveway::schema

namespace giveway {

void Set(const VehicleOptions& options, schema::Vehicle* message);
void Set(const VehicleOptions& options, schema::Spawn* message);

}  // namespace giveway

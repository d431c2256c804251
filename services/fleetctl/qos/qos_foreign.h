// The QoS of a vehicle with another vendor's DDS: it takes no orders, but discovery reports what
// its endpoints offer and request.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/qos/qos_effective.h"
#include "services/link/fastdds/found_endpoint.h"
#include "services/link/fastdds/link_options.h"
#include "services/types/ids.h"

namespace giveway::fleetctl {

struct ForeignVehicle {
  std::string vendor;  // "Eclipse Cyclone DDS"
  std::vector<EffectiveEndpoint> endpoints;
};

// Waits some seconds for one whose writers name the vehicle and whose DDS is another vendor's.
std::optional<ForeignVehicle> SeekForeign(const link::LinkOptions& options, VehicleId vehicle);

// Its endpoints on topics of the fleet, under the names of their profiles.
std::vector<EffectiveEndpoint> EffectiveForeign(const std::vector<link::FoundEndpoint>& endpoints);

}  // namespace giveway::fleetctl

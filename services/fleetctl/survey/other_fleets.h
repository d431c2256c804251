// Fleets of this machine that have the domain number of the one that is listened to, and another
// network: they are not heard, and the operator should know that there is a choice.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/survey/why_proc.h"

namespace giveway::fleetctl {

// A line for each: every network of the domain but the one that is `interface` in the namespace.
std::vector<std::string> OtherFleets(const std::vector<FleetMember>& members, std::uint32_t domain,
                                     const std::string& interface, std::uint64_t network_namespace);

// Says them on stderr, of the processes that can be seen from here.
void SayOtherFleets(std::uint32_t domain, const std::string& interface);

}  // namespace giveway::fleetctl

// Fleets on this machine with the domain number of the one that is observed, but on another
// network: they cannot be heard, and the operator should know about them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/survey/why_proc.h"

namespace giveway::fleetctl {

// A line for each: every network of the domain except the one that is `interface` in the namespace.
std::vector<std::string> OtherFleets(const std::vector<FleetMember>& members, std::uint32_t domain,
                                     const std::string& interface, std::uint64_t network_namespace);

// Reports them on stderr, from the processes that are visible from here.
void ReportOtherFleets(std::uint32_t domain, const std::string& interface);

}  // namespace giveway::fleetctl

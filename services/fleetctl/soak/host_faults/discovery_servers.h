// The discovery servers that a soak starts for its fleet: Fast DDS's own program, each on a UDP
// port of this host that was free. Starts nothing itself: the commands are the fleet's, see
// process/fleet_processes.h. What is wrong with a server is the library's, so its memory and
// descriptors are not judged.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/process/fleet_commands.h"
#include "services/types/discovery_server.h"

namespace giveway::fleetctl {

inline constexpr std::uint32_t kMostDiscoveryServers = 4;

// Empty: discovery servers can be started for a fleet on this interface. Otherwise why not.
// `interface` is the fleet's; servers listen on an address, which a name does not say.
std::string WhyNoDiscoveryServers(const std::string& interface);

// `count` addresses on the IPv4 address `interface`, each with a port that is free now. Throws
// StartError.
std::vector<DiscoveryServer> FreeServerAddresses(std::uint32_t count, const std::string& interface);

// A command of each, in the order of the addresses. Logs are kept in `logs_folder`.
std::vector<MemberCommand> ServerCommands(const std::vector<DiscoveryServer>& addresses,
                                          const std::string& logs_folder);

}  // namespace giveway::fleetctl

// The addresses of discovery servers that are named by host.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/types/discovery_server.h"

namespace giveway::link {

struct ServerAddress {
  std::string ipv4;
  std::uint16_t port = 0;
};

struct FoundServers {
  std::vector<ServerAddress> addresses;  // of those that have one, in the order of the servers
  std::string fault;  // one sentence that names those that have none, and why; empty: all have one
};

// Asks for each name; may take seconds where no name server answers.
FoundServers FindServers(const std::vector<DiscoveryServer>& servers);

}  // namespace giveway::link

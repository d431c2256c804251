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

// Asks for each name; may take seconds where no name server answers. A name that has no address is
// left empty.
std::vector<ServerAddress> AddressesOf(const std::vector<DiscoveryServer>& servers);

// Of those servers whose name has no address, one sentence that says which and why; empty if there
// are none. May take seconds.
std::string WhyNoAddress(const std::vector<DiscoveryServer>& servers);

}  // namespace giveway::link

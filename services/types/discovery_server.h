// Where discovery servers listen, as users write it: for fleets whose network passes no multicast.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace giveway {

inline constexpr std::uint16_t kDiscoveryServerPort = 11811;  // fast-discovery-server's own default

struct DiscoveryServer {
  std::string host;  // an IPv4 address, or a name that has one
  std::uint16_t port = kDiscoveryServerPort;

  friend bool operator==(const DiscoveryServer&, const DiscoveryServer&) = default;
};

struct ParsedDiscoveryServers {
  std::vector<DiscoveryServer> servers;  // the place in the list is the server's id, from 0
  std::string fault;                     // empty: none
};

// HOST[:PORT][,HOST[:PORT]...], at most 16.
ParsedDiscoveryServers ParseDiscoveryServers(std::string_view text);
// The same text, ports always written.
std::string ToText(const std::vector<DiscoveryServer>& servers);

}  // namespace giveway

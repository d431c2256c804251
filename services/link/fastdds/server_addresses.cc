#include "services/link/fastdds/server_addresses.h"

#include <arpa/inet.h>
#include <netdb.h>

#include <memory>
#include <utility>

namespace giveway::link {
namespace {

struct Lookup {
  std::string ipv4;  // empty: none
  std::string fault;
};

struct FreeAddresses {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};

Lookup LookUp(const std::string& host) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* list = nullptr;
  const int error = getaddrinfo(host.c_str(), nullptr, &wanted, &list);
  if (error != 0) return {"", gai_strerror(error)};
  const std::unique_ptr<addrinfo, FreeAddresses> found(list);
  char text[INET_ADDRSTRLEN];
  const auto* address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
  inet_ntop(AF_INET, &address->sin_addr, text, sizeof text);
  return {text, ""};
}

}  // namespace

FoundServers FindServers(const std::vector<DiscoveryServer>& servers) {
  FoundServers found;
  for (const auto& [host, port] : servers) {
    const Lookup lookup = LookUp(host);
    if (!lookup.ipv4.empty()) {
      found.addresses.push_back({lookup.ipv4, port});
      continue;
    }
    found.fault += found.fault.empty() ? "discovery server " : ", ";
    found.fault += host + " (" + lookup.fault + ")";
  }
  if (found.fault.empty()) return found;
  found.fault += " has no address yet: is its name right, and does it run?";
  return found;
}

}  // namespace giveway::link

#include "services/link/fastdds/interfaces.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "services/link/fastdds/link_options.h"

namespace giveway::link {

std::vector<Interface> Ipv4Interfaces() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) {
    throw LinkError(std::string("cannot list the network interfaces: ") + std::strerror(errno));
  }
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> list(first, freeifaddrs);
  std::vector<Interface> found;
  for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next) {
    if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address;
    std::memcpy(&address, at->ifa_addr, sizeof(address));
    char text[INET_ADDRSTRLEN];
    if (inet_ntop(AF_INET, &address.sin_addr, text, sizeof(text)) == nullptr) continue;
    const auto says = [at](unsigned flag) { return (at->ifa_flags & flag) != 0; };
    found.push_back({at->ifa_name, text, says(IFF_UP), says(IFF_LOOPBACK), says(IFF_MULTICAST),
                     if_nametoindex(at->ifa_name)});
  }
  return found;
}

std::vector<std::string> ResolveInterface(const std::string& interface) {
  if (interface == "any") return {};
  std::vector<std::string> addresses;
  std::string there;
  for (const Interface& one : Ipv4Interfaces()) {
    if (one.name == interface || one.address == interface) addresses.push_back(one.address);
    there += (there.empty() ? "" : ", ") + one.name + " (" + one.address + ")";
  }
  if (there.empty()) {
    throw LinkError(
        "this machine has no IPv4 interface that is up, not even the loopback; as root: "
        "ip link set lo up");
  }
  if (addresses.empty()) {
    throw LinkError("interface \"" + interface +
                    "\" is no IPv4 interface of this machine; give a name or an address of: " +
                    there + "; or \"any\"");
  }
  return addresses;
}

}  // namespace giveway::link

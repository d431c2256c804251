// Sends one datagram to the multicast group of Fast DDS discovery, and listens for it on this host.
#pragma once

#include <optional>
#include <string>

namespace giveway::fleetctl {

// Whether it came back through the interface with this IPv4 address; nullopt if that could not be
// tried. The datagram does not leave the host, and goes to no port of DDS.
std::optional<bool> EchoesMulticast(const std::string& address);

}  // namespace giveway::fleetctl

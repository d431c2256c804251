// An IPv4 address as text. Pure.
#pragma once

#include <arpa/inet.h>

#include <optional>
#include <string>

namespace giveway::fleetctl {

// Nothing of a name, or of "any".
inline std::optional<in_addr> Ipv4AddressOf(const std::string& text) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  return address;
}

}  // namespace giveway::fleetctl

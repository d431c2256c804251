#include "services/types/discovery_server.h"

#include <algorithm>
#include <charconv>

namespace giveway {
namespace {

constexpr std::size_t kMostServers = 16;
constexpr std::size_t kLongestName = 253;  // of a host, RFC 1035

bool IsOfHostName(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '-' || c == '_';
}

// Without the sum of a literal and a temporary, whose copies g++ 12 takes for endless at -O3.
std::string Quoted(std::string_view text) {
  std::string quoted(1, '"');
  quoted += text;
  quoted += '"';
  return quoted;
}

// Why it is none; empty if it is one.
std::string ReadServer(std::string_view text, DiscoveryServer* server) {
  const std::size_t colon = text.find(':');
  const std::string_view host = text.substr(0, colon);
  if (host.empty() || host.size() > kLongestName || !std::ranges::all_of(host, IsOfHostName)) {
    return Quoted(host) + " is no host";
  }
  server->host = host;
  if (colon == std::string_view::npos) return {};
  const std::string_view port = text.substr(colon + 1);
  const char* end = port.data() + port.size();
  const auto [stop, error] = std::from_chars(port.data(), end, server->port);
  if (error == std::errc{} && stop == end && server->port != 0) return {};
  return Quoted(port) + " is no port from 1 to 65535";
}

}  // namespace

ParsedDiscoveryServers ParseDiscoveryServers(std::string_view text) {
  ParsedDiscoveryServers parsed;
  while (parsed.fault.empty()) {
    const std::size_t comma = text.find(',');
    parsed.fault = ReadServer(text.substr(0, comma), &parsed.servers.emplace_back());
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
    if (parsed.servers.size() == kMostServers) parsed.fault = "more than 16 servers";
  }
  if (!parsed.fault.empty()) parsed.servers.clear();
  return parsed;
}

std::string ToText(const std::vector<DiscoveryServer>& servers) {
  std::string text;
  for (const auto& [host, port] : servers) {
    text += (text.empty() ? "" : ",") + host + ":" + std::to_string(port);
  }
  return text;
}

}  // namespace giveway

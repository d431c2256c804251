#include "services/observer/server/request_rules.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>

namespace giveway {
namespace {

bool IsPort(std::string_view port) {
  return !port.empty() && port.size() <= 5 &&
         std::ranges::all_of(port, [](char c) { return c >= '0' && c <= '9'; });
}

bool IsAddress(int family, const std::string& text) {
  in6_addr address{};  // large enough for either
  return inet_pton(family, text.c_str(), &address) == 1;
}

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return lower;
}

// "[::1]:8080" and "[::1]".
bool IsIpv6Host(std::string_view host) {
  const std::size_t end = host.find(']');
  if (end == std::string_view::npos) return false;
  const std::string_view after = host.substr(end + 1);
  if (!after.empty() && (after.front() != ':' || !IsPort(after.substr(1)))) return false;
  return IsAddress(AF_INET6, std::string(host.substr(1, end - 1)));
}

}  // namespace

bool IsOwnHost(std::string_view host, const std::vector<std::string>& names) {
  if (host.empty() || host.size() > 255) return false;
  if (host.front() == '[') return IsIpv6Host(host);
  const std::size_t colon = host.find(':');
  if (colon != std::string_view::npos && !IsPort(host.substr(colon + 1))) return false;
  const std::string name = Lower(host.substr(0, colon));
  if (name == "localhost" || IsAddress(AF_INET, name)) return true;
  return std::ranges::any_of(names, [&](const std::string& own) { return Lower(own) == name; });
}

std::optional<VehicleId> VehicleOfPath(std::string_view rest) {
  std::uint32_t id = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), id);
  if (error != std::errc{} || end != rest.data() + rest.size() || id == 0) return std::nullopt;
  if (rest.front() == '0') return std::nullopt;
  return VehicleId{id};
}

}  // namespace giveway

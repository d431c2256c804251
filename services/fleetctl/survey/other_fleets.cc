#include "services/fleetctl/survey/other_fleets.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include "services/fleetctl/survey/why_proc_text.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

// Two names of the loopback.
std::string NetworkOf(const std::string& interface) {
  return interface == "lo" ? "127.0.0.1" : interface;
}

}  // namespace

std::vector<std::string> OtherFleets(const std::vector<FleetMember>& members, std::uint32_t domain,
                                     const std::string& interface,
                                     std::uint64_t network_namespace) {
  using Network = std::pair<std::uint64_t, std::string>;
  const Network own{network_namespace, NetworkOf(interface)};
  std::map<Network, std::string> others;
  for (const FleetMember& member : members) {
    if (member.domain != domain || !member.network_namespace) continue;
    const Network network{*member.network_namespace, NetworkOf(member.interface)};
    if (network != own) others[network] += fmt::format(" pid:{}", member.pid);
  }
  std::vector<std::string> lines;
  for (const auto& [network, pids] : others) {
    const bool inside = network.first == network_namespace;
    // An interface is a word of any user's command line.
    lines.push_back(Printable(fmt::format(
        "domain {} is also that of a fleet which is not asked here, on interface {}{} "
        "(processes{}): "
        "choose it by {}",
        domain, network.second,
        inside ? "" : fmt::format(" of network namespace {}", network.first), pids,
        inside ? "--interface " + network.second : "running fleetctl there, see nsenter(1)")));
  }
  return lines;
}

void ReportOtherFleets(std::uint32_t domain, const std::string& interface) {
  std::error_code error;
  const auto link = std::filesystem::read_symlink("/proc/self/ns/net", error);
  const auto own = error ? std::nullopt : ParseBracketed(link.string(), "net");
  if (!own) return;
  for (const std::string& line : OtherFleets(FindFleet("/proc"), domain, interface, *own)) {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
}

}  // namespace giveway::fleetctl

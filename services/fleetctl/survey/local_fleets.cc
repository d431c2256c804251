#include "services/fleetctl/survey/local_fleets.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "services/config/problem.h"
#include "services/fleetctl/survey/why_proc_text.h"

namespace giveway::fleetctl {

std::vector<LocalFleet> LocalFleets(const std::vector<FleetMember>& members) {
  std::map<std::tuple<std::uint32_t, std::string, std::uint64_t>, LocalFleet> fleets;
  for (const FleetMember& member : members) {
    if (member.domain == 0 || !member.network_namespace) continue;
    const std::string interface = member.interface == "lo" ? "127.0.0.1" : member.interface;
    LocalFleet& fleet = fleets[{member.domain, interface, *member.network_namespace}];
    fleet.domain = member.domain;
    fleet.interface = interface;
    fleet.network_namespace = *member.network_namespace;
    if (member.is_world) {
      fleet.worlds.push_back(member.pid);
    } else {
      fleet.vehicles.push_back(member);
    }
  }
  std::vector<LocalFleet> sorted;
  for (auto& [key, fleet] : fleets) {
    std::ranges::stable_sort(fleet.vehicles, {}, &FleetMember::id);
    sorted.push_back(std::move(fleet));
  }
  return sorted;
}

std::vector<LocalFleet> LocalFleets() { return LocalFleets(FindFleet("/proc")); }

std::optional<std::uint64_t> OwnNetworkNamespace() {
  std::error_code error;
  const auto link = std::filesystem::read_symlink("/proc/self/ns/net", error);
  return error ? std::nullopt : ParseBracketed(link.string(), "net");
}

void FindFleetIfNotNamed(ObserverOptions* options) {
  if (options->domain != 0) return;
  const ChosenFleet chosen = ChooseFleet(LocalFleets(), OwnNetworkNamespace().value_or(0));
  if (!chosen.fleet) {
    throw InputError({{"--domain", 0, "", "", chosen.why, "fleetctl ls lists the fleets"}});
  }
  options->domain = chosen.fleet->domain;
  if (options->interface == ObserverOptions{}.interface) {
    options->interface = chosen.fleet->interface;
  }
}

ChosenFleet ChooseFleet(const std::vector<LocalFleet>& fleets, std::uint64_t network_namespace) {
  ChosenFleet chosen;
  std::string listed;
  for (const LocalFleet& fleet : fleets) {
    if (fleet.network_namespace != network_namespace) continue;
    listed += fmt::format("{}{} (interface {}, {} vehicles)", listed.empty() ? "" : ", ",
                          fleet.domain, fleet.interface, fleet.vehicles.size());
    if (chosen.why.empty() && !chosen.fleet) {
      chosen.fleet = fleet;
    } else {
      chosen.fleet.reset();
      chosen.why = "several fleets run on this machine, in the domains " + listed +
                   ": choose one with --domain (and --interface)";
    }
  }
  if (listed.empty()) {
    chosen.why = "no fleet runs on this machine: give --domain for one on another";
  }
  return chosen;
}

}  // namespace giveway::fleetctl

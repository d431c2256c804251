// The fleets that run on this machine, from /proc alone: for `fleetctl ls`, and for verbs without
// --domain.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/args/observer_session.h"
#include "services/fleetctl/survey/why_proc.h"

namespace giveway::fleetctl {

// The processes of one domain on one interface in one network namespace.
struct LocalFleet {
  std::uint32_t domain = 0;
  std::string interface;
  std::uint64_t network_namespace = 0;
  std::vector<int> worlds;            // process ids
  std::vector<FleetMember> vehicles;  // by id
};

// By domain, interface and namespace. Processes whose namespace cannot be read are left out.
std::vector<LocalFleet> LocalFleets(const std::vector<FleetMember>& members);
// Those of this machine.
std::vector<LocalFleet> LocalFleets();

// The network namespace of this process; nullopt if /proc does not show it.
std::optional<std::uint64_t> OwnNetworkNamespace();

// The only fleet of the namespace, or why there is none: `why` is then a sentence for the user.
struct ChosenFleet {
  std::optional<LocalFleet> fleet;
  std::string why;
};
ChosenFleet ChooseFleet(const std::vector<LocalFleet>& fleets, std::uint64_t network_namespace);

// Without a domain: that of the only fleet here. Throws InputError if none runs, or several do.
void FindFleetIfNotNamed(ObserverOptions* options);

}  // namespace giveway::fleetctl

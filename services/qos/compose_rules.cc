// Containers of a fleet: what their network, memory and variables do to profile sets that are sound
// by themselves.
#include <algorithm>

#include "services/qos/compose.h"
#include "services/qos/qos_rules.h"

namespace giveway::qos {
namespace {

void CheckDomains(const std::vector<ComposeService>& services, Findings* findings) {
  const ComposeService* first = nullptr;
  for (const ComposeService& service : services) {
    const ComposeVariable& domain = service.domain;
    if (domain.value.empty()) continue;
    if (first == nullptr) {
      first = &service;
      continue;
    }
    const ComposeVariable& other = first->domain;
    if (domain.value == other.value) continue;
    findings->push_back({Severity::kError, "domain_split", domain.place, service.name,
                         domain.name + " " + domain.value + ", and " + other.value + " in " +
                             first->name + " (line " + std::to_string(other.place.line) + ")",
                         "The two never hear of each other.", "one domain for the whole fleet"});
  }
}

}  // namespace

void CheckCompose(const std::vector<ComposeService>& services, Findings* findings) {
  for (const ComposeService& service : services) {
    for (const ComposeVariable& variable : service.environment) {
      CheckVariable(variable.name, variable.place, "is set for " + service.name, findings);
    }
  }
  CheckDomains(services, findings);
}

void CheckComposeSet(const ComposeService& service, const ProfileSet& set, Findings* findings) {
  if (!UsesSharedMemory(set) || (service.host_network && service.host_ipc)) return;
  if (service.host_network) {
    findings->push_back(
        {Severity::kError, "host_network_without_ipc", service.place, service.name,
         "network_mode host without ipc host, and shared memory in " + set.file,
         "All take each other for processes of one host and write into memory that no other "
         "sees: they match, and hear nothing.",
         "ipc: host together with network_mode: host, or a set without shared memory"});
    return;
  }
  findings->push_back({Severity::kWarning, "shared_memory_apart", service.place, service.name,
                       "shared memory in " + set.file + ", and a network of its own",
                       "Containers with networks of their own take each other for other hosts: "
                       "all goes over UDP, and the segments cost memory for nothing.",
                       "a set without shared memory"});
}

}  // namespace giveway::qos

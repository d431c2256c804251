#include "services/fleetctl/args/observer_flags.h"

#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/process/domain_lock.h"

namespace giveway::fleetctl {
void AddObserverFlags(CLI::App* verb, ObserverOptions* options) {
  verb->add_option("--domain", options->domain,
                   "DDS domain of the fleet; may be left out where one runs on this machine")
      ->check(CLI::Range(kFirstDomain, kLastDomain))
      ->envname("GIVEWAY_DOMAIN");
  AddInterfaceFlag(verb, &options->interface);
  AddDiscoveryFlag(verb, &options->discovery_servers);
  verb->add_option("--area", options->area,
                   "Area of the fleet, the first part of its beacons' partition")
      ->check(CheckNotEmpty)
      ->capture_default_str();
  verb->add_option(
          "--qos", options->qos_file,
          "Fast DDS XML profiles, a file or a shipped set: give the one the fleet runs with")
      ->default_str("default")
      ->type_name("SET|FILE")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_QOS");
}

void AddAdminKeyFlag(CLI::App* verb, std::string* file) {
  verb->add_option(
          "--admin-key", *file,
          "Orders are sealed with the key in this file; without it, with that of the fleet "
          "that fleetctl run started here")
      ->type_name("FILE")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_ADMIN_KEY");
}

}  // namespace giveway::fleetctl

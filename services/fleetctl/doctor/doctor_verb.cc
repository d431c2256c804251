#include <memory>

#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/doctor/doctor.h"
#include "services/fleetctl/process/domain_lock.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kDoctorFooter = R"(
Looks at what a fleet needs of this host: shared memory (unused files, files of other users, free space), network
namespaces without a common shared memory, host ids, multicast, receive buffers, ports and participant
ids, files and variables the library reads by itself, the wall clock, descriptors. Each finding says what
comes of it and what to do. As root it sees all processes; else it says what it could not see.

--fix removes the files of Fast DDS in /dev/shm that no process has open or mapped, one line each: the
kernel confirms it, by the lease it grants, as each is removed. It changes nothing else.

Examples
  fleetctl doctor                                  # before a fleet is started
  fleetctl doctor --vehicles 200 --qos same_host --domain 7
  fleetctl doctor --fix
  fleetctl doctor --json | jq -r '.findings[].rule'

Exit code: 0 nothing found; 1 something was, or with --fix is left; 2 could not examine.
)";

}  // namespace

void AddDoctorVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<DoctorOptions>();
  CLI::App* verb =
      fleetctl->add_subcommand("doctor", "Examine this host, and clean up after fleets");
  verb->footer(kDoctorFooter);
  verb->add_option("--domain", options->domain,
                   "DDS domain, and its processes; without it all that run, else 1")
      ->check(CLI::Range(kFirstDomain, kLastDomain))
      ->envname("GIVEWAY_DOMAIN");
  verb->add_option("--vehicles", options->vehicles, "How many are to run here")
      ->check(CLI::Range(1U, kMostReckonedWith))
      ->capture_default_str();
  verb->add_option("--qos", options->qos,
                   "Profile file, or name of a shipped set, they are started with")
      ->envname("GIVEWAY_QOS");
  AddInterfaceFlag(verb, &options->interface);
  AddDiscoveryFlag(verb, &options->discovery_servers);
  verb->add_flag("--fix", options->fix, "Remove unused files in shared memory");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->add_flag("--quiet", options->quiet, "Print nothing: the exit code says it");
  verb->callback([options, exit_code] { *exit_code = RunDoctor(*options); });
}

}  // namespace giveway::fleetctl

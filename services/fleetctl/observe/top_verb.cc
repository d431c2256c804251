#include <memory>

#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/observer_flags.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/observe/top.h"
#include "services/fleetctl/survey/local_fleets.h"
#include "services/fleetctl/survey/other_fleets.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kTopFooter = R"(
Only listens: starts nothing, stops nothing. Statuses are heard of all areas, beacons of one.
'beacon' is the age of the newest one; 'events' are what the vehicle has counted about its peers: its
deadlines missed, its peers lost, beacons refused, and the peer each was about last.
Without a terminal it prints a block a second, with --json an object a second.
Start it after the fleet: fleetctl run takes no domain in which another process listens.

Examples
  fleetctl top --domain 7
  fleetctl top --domain 7 --once --json | jq '.vehicles[] | select(.hearing != "heard").id'

Exit code: 0 shown, or ended by Ctrl-C; 1 with --once: nothing received; 2 could not run.
)";

}  // namespace

void AddTopVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<TopOptions>();
  CLI::App* verb =
      fleetctl->add_subcommand("top", "A live table of a fleet that was started elsewhere");
  verb->footer(kTopFooter);
  AddObserverFlags(verb, &options->where);
  CLI::Option* once = verb->add_flag("--once", options->once, "Show the state once, and end");
  AddTimeFlag(verb, "--wait", &options->wait_s, "With --once: wait at most this time [5s]")
      ->needs(once);
  verb->add_flag("--json", options->json, "Print JSON objects on stdout and nothing else");
  verb->callback([options, exit_code] {
    FindFleetIfNotNamed(&options->where);
    ReportOtherFleets(options->where.domain, options->where.interface);
    *exit_code = RunTop(*options);
  });
}

}  // namespace giveway::fleetctl

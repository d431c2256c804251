#include <memory>
#include <set>

#include "services/fleetctl/flag_checks.h"
#include "services/fleetctl/observer_flags.h"
#include "services/fleetctl/other_fleets.h"
#include "services/fleetctl/qos_apply.h"
#include "services/fleetctl/verbs.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kFooter = R"(
A PROFILE is a path, or the name of a shipped set. It is checked first, alone and beside what the
vehicles run with. A deadline takes effect while the vehicle drives. Everything else is fixed once a
participant is made: the vehicle halts, restarts itself (same process id, same place in the world)
and drives on, one vehicle after the other. The world keeps its own profiles.
With --canary one vehicle goes first. It is watched beside the rest for --watch seconds: if it hears
less, loses more beacons or raises more alarms than chance explains, it goes back to what it had.

Examples
  fleetctl qos apply mine.xml --to 1,2,3 --domain 7 --dry-run    # what would change, and how
  fleetctl qos apply lossy_radio --to 1,2,3 --domain 7 --canary 2 --watch 30

Exit code: 0 in effect, or nothing to do; 1 refused, rolled back, or not seen to be in effect;
2 could not run, and nothing was changed.
)";

void CheckTargets(const QosApplyOptions& options) {
  const std::set<std::uint32_t> once(options.to.begin(), options.to.end());
  if (once.size() != options.to.size()) throw CLI::ValidationError("--to", "names a vehicle twice");
  if (options.canary == 0) return;
  if (!once.contains(options.canary)) {
    throw CLI::ValidationError("--canary", "must be one of --to");
  }
}

}  // namespace

void AddQosApply(CLI::App* qos, int* exit_code) {
  const auto options = std::make_shared<QosApplyOptions>();
  CLI::App* verb = qos->add_subcommand("apply", "Give running vehicles other QoS");
  verb->footer(kFooter);
  verb->add_option("PROFILE", options->profile, "What they shall run with")
      ->required()
      ->check(CheckNotEmpty);
  AddObserverFlags(verb, &options->where);
  verb->add_option("--to", options->to, "Vehicle ids")
      ->required()
      ->delimiter(',')
      ->check(CLI::Range(1U, 4294967295U))
      ->type_name("ID,...");
  CLI::Option* canary =
      verb->add_option("--canary", options->canary, "This one first, on trial")->type_name("ID");
  verb->add_option("--watch", options->watch_s, "Seconds the canary is on trial")
      ->check(CheckSeconds)
      ->capture_default_str()
      ->needs(canary);
  verb->add_flag("!--no-restart", options->restart, "Refuse what would take a restart");
  verb->add_flag("--dry-run", options->dry_run, "Say what would change, and change nothing");
  verb->add_flag("--force", options->force,
                 "Though vehicles with the old and the new profiles would not hear each other");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, exit_code] {
    CheckTargets(*options);
    SayOtherFleets(options->where.domain, options->where.interface);
    *exit_code = RunQosApply(*options);
  });
}

}  // namespace giveway::fleetctl

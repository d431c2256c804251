#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/observer_flags.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/process/whole_number.h"
#include "services/fleetctl/qos/qos_apply.h"
#include "services/fleetctl/survey/local_fleets.h"
#include "services/fleetctl/survey/other_fleets.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kApplyFooter = R"(
A PROFILE is a path, or the name of a shipped set. It is checked first, alone and together with what
every process of the fleet runs with; a child process then makes every endpoint of it with Fast DDS.
A deadline takes effect while the vehicle drives. Everything else is fixed once a participant is
made: the vehicle halts, restarts itself (same process id, same place in the world) and drives on,
one after the other; so does the world, with the run as it was. What cannot make its participant
comes back with what it had.
Every writer matches every reader at every moment. Where old and new do not match, each process
first takes an intermediate set, in which writers offer the more of both and readers request the less.
Where a process that is not in --to forbids it, the value that does is named.
With --canary one vehicle goes first. It is compared with the rest for the time --watch: if it hears
less, loses more beacons or raises more alarms than chance explains, all go back to what they had.

Examples
  fleetctl qos apply mine.xml --to 1,2,3 --domain 7 --dry-run    # what would change, and how
  fleetctl qos apply lossy_radio --to all --domain 7 --canary 2 --watch 5

Exit code: 0 in effect, or nothing to do; 1 refused, rolled back, or not seen to be in effect;
2 could not run, and nothing was changed.
)";

// Whole numbers from 1, or the word.
void ReadTargets(const std::vector<std::string>& words, QosApplyOptions* options) {
  options->all = words == std::vector<std::string>{"all"};
  if (options->all) return;
  for (const std::string& word : words) {
    const auto id = WholeNumber<std::uint32_t>(word);
    if (!id || *id == 0) {
      throw CLI::ValidationError("--to", "must be vehicle ids from 1, or all, not '" + word + "'");
    }
    options->to.push_back(*id);
  }
}

void CheckTargets(const QosApplyOptions& options) {
  const std::set<std::uint32_t> once(options.to.begin(), options.to.end());
  if (once.size() != options.to.size()) throw CLI::ValidationError("--to", "names a vehicle twice");
  if (options.canary == 0 || options.all) return;
  if (!once.contains(options.canary)) {
    throw CLI::ValidationError("--canary", "must be one of --to");
  }
}

}  // namespace

void AddQosApply(CLI::App* qos, int* exit_code) {
  const auto options = std::make_shared<QosApplyOptions>();
  CLI::App* verb = qos->add_subcommand("apply", "Give running vehicles other QoS");
  verb->footer(kApplyFooter);
  verb->add_option("PROFILE", options->profile, "The set they are to run with")
      ->required()
      ->check(CheckNotEmpty);
  AddObserverFlags(verb, &options->where);
  AddAdminKeyFlag(verb, &options->where.admin_key);
  const auto targets = std::make_shared<std::vector<std::string>>();
  verb->add_option("--to", *targets, "Vehicle ids; all: every vehicle, and the world")
      ->required()
      ->delimiter(',')
      ->type_name("ID,...|all");
  CLI::Option* canary = verb->add_option("--canary", options->canary, "This one first, on trial")
                            ->type_name("ID")
                            ->check(CLI::Range(1U, std::numeric_limits<std::uint32_t>::max()));
  AddTimeFlag(verb, "--watch", &options->watch_s, "How long the canary is on trial")
      ->default_str("10s")
      ->needs(canary);
  verb->add_flag("!--no-restart", options->restart, "Refuse what would take a restart");
  verb->add_flag("--dry-run", options->dry_run, "Say what would change, and change nothing");
  verb->add_flag("--force", options->force,
                 "At once, though processes with the old and the new would not hear each other");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, targets, exit_code] {
    ReadTargets(*targets, options.get());
    CheckTargets(*options);
    FindFleetIfNotNamed(&options->where);
    ReportOtherFleets(options->where.domain, options->where.interface);
    *exit_code = RunQosApply(*options);
  });
}

}  // namespace giveway::fleetctl

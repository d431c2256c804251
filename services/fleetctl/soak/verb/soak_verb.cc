#include <limits>
#include <memory>
#include <string>

#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/soak/host_faults/discovery_servers.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/verb/soak.h"
#include "services/fleetctl/soak/verb/soak_around.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kSoakFooter = R"(
Starts a world and one process a vehicle, waits until all drive, breaks things
by a seeded schedule, heals everything, and judges: every invariant, every
fault's effect, how soon peers noticed, that all drive again within 5 s, that no
process grows. A process that ends by itself is restarted and reported. The report
folder gets report.html, report.json, the logs, the scenario and the list of
faults as they were run; `fleetctl report` reads it. The first Ctrl-C ends the
soak with an honest report.

With --record-ring every vehicle keeps its last seconds; a broken promise makes
all of them keep those files. --around FOLDER writes the faults around the first
broken promise of a report, for `fleetctl shrink`.

--virtual runs the same list in virtual time, as far as it goes there, and
judges it alike, without detection, resources and pauses. It cannot be resumed:
the same command gives the same run.

A soak of processes saves what was seen every ten seconds, more rarely as it
grows: --resume FOLDER continues after a crash of the machine, with a new fleet
and the rest of the list, and the verdict says so. Give --record or --record-ring
to it again.

Faults of an intruder (spoofed, replayed, flooded, malformed) are carried out by
the program that is built with the tests: --attacker build/release/bin/attacker.
It needs root. Faults of discovery servers need --discovery-servers.

A TIME is seconds, or has a unit: 90, 90s, 30m, 12h, 7d. Faults are files or
shipped sets: calm, radio_storm, flaky_hardware, everything. Those of the scenario
itself are carried out with them. No random fault starts in the first 10 s and half
a second a vehicle, and all are over 20 s before the end, each a quarter of the
duration at most. To see the list of a file before a soak, give `fleetctl faults
expand` its seed and these times as --warm-up and --healing; in the report folder
the whole list is faults.textproto.

Examples
  fleetctl soak patrol --faults calm --duration 2m --report soak
  fleetctl soak patrol --faults everything --skip-unsupported --duration 30m \
      --seed 7 --record-ring 60 --report soak
  fleetctl report soak
  fleetctl soak --around soak
  fleetctl soak city_grid --faults everything --skip-unsupported --virtual \
      --duration 12h --report night

Exit code: 0 passed; 1 failed or interrupted; 2 could not run, or the machine
was too busy to judge.
)";

void AddSoakFlags(CLI::App* verb, SoakOptions* options) {
  verb->add_option("SCENARIO", options->scenario,
                   "A scenario file, or the name of a shipped one (required, unless --resume or "
                   "--around)");
  verb->add_option("--faults", options->faults,
                   "A fault file, or the name of a shipped one, besides the scenario's own")
      ->check(CheckNotEmpty)
      ->default_str("calm where the scenario has none");
  AddDurationFlag(verb, "--duration", &options->duration_s,
                  "From the start signal to the verdict: 30s to 30d")
      ->default_str("5m");
  verb->add_option("--seed", options->seed, "Of start poses, cruise speeds and faults")
      ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()))
      ->capture_default_str();
  verb->add_option(
          "--report", options->report_folder,
          "Folder of the report; made where it is not (required, unless --resume or --around)")
      ->check(CheckNotEmpty);
  verb->add_option("--vehicles", options->vehicles, "Of an open fleet; without it one a place")
      ->check(CLI::Range(1U, kMostStarted));
  verb->add_option("--qos", options->qos_file, "QoS profiles: a file, or the name of a shipped set")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_QOS");
  verb->add_option("--domain", options->domain, "DDS domain; without it the first free one")
      ->check(CLI::Range(kFirstDomain, kLastDomain));
  AddInterfaceFlag(verb, &options->interface);
  verb->add_option(
          "--admin-key", options->admin_key,
          "Orders of the soak to its fleet are sealed with the key in this file; without it, the "
          "soak makes a key for itself")
      ->type_name("FILE")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_ADMIN_KEY");
  verb->add_option("--discovery-servers", options->discovery_servers,
                   "Discovery servers that the soak starts for its fleet")
      ->check(CLI::Range(0U, kMostDiscoveryServers))
      ->capture_default_str();
  verb->add_option("--attacker", options->attacker,
                   "Program that carries out spoofed, replayed, flooded, malformed; needs root")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_ATTACKER");
  verb->add_flag("--record", options->record, "Every vehicle records into the report folder");
  verb->add_option("--record-ring", options->ring_s,
                   "Every vehicle keeps its last seconds recorded: 60")
      ->check(CLI::Range(5U, 3600U))
      ->excludes("--record");
  verb->add_flag("--virtual", options->in_virtual_time, "In virtual time: the same bits each time")
      ->excludes("--record")
      ->excludes("--record-ring")
      ->excludes("--domain")
      ->excludes("--discovery-servers");
  verb->add_option("--resume", options->resume, "Continue in this folder of a soak that died")
      ->check(CheckNotEmpty)
      ->excludes("--report")
      ->excludes("SCENARIO")
      ->excludes("--virtual")
      ->excludes("--faults")
      ->excludes("--duration")
      ->excludes("--seed")
      ->excludes("--vehicles");
  verb->add_option("--around", options->around, "Write the faults around the first broken promise")
      ->check(CheckNotEmpty)
      ->excludes("--report")
      ->excludes("SCENARIO");
  verb->add_flag("--skip-unsupported", options->skip_unsupported,
                 "Leave out what cannot be done here, and say so");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
}

void RequireWhatIsRun(const SoakOptions& options) {
  if (!options.resume.empty()) return;
  if (options.scenario.empty()) throw CLI::RequiredError("SCENARIO");
  if (options.report_folder.empty()) throw CLI::RequiredError("--report");
}

}  // namespace

void AddSoakVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<SoakOptions>();
  CLI::App* verb = fleetctl->add_subcommand(
      "soak", "Drive a fleet under faults for minutes or days, and judge it");
  verb->footer(kSoakFooter);
  AddSoakFlags(verb, options.get());
  verb->callback([options, exit_code] {
    if (!options->around.empty()) {
      *exit_code = WriteAround(options->around);
      return;
    }
    RequireWhatIsRun(*options);
    if (options->resume.empty() && options->duration_s < kLeastSoak_s) {
      throw CLI::ValidationError("--duration",
                                 "must be at least 30 s: the fleet takes ten to start");
    }
    *exit_code = Soak(*options);
  });
}

}  // namespace giveway::fleetctl

#include <limits>
#include <memory>
#include <string>

#include "services/config/impair.h"
#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/tune/tune_run.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kTuneFooter = R"(
Searched, of fleet/beacon: requested and offered deadline, liveliness lease, reliability, the reader's
depth. Not searched: the beacon period, which is the scenario's tick and no QoS; the heartbeat of
reliable writers, which code sets to 100 ms and no profile changes; the beacon age limit, which is
the scenario's.

Each candidate is the base with values replaced, passes `fleetctl qos check` without an error, and is
run by real vehicles in a domain of its own: watched while all are alive, when every alarm is a
false one, then up to three are killed (kill -9). All get one trial, the better half more, and so on.
  false alarm    a vehicle stops believing a living peer, by deadline,
                 liveliness or beacon age
  noticed after  from a killed vehicle's last beacon to the cycle of the
                 control loop in which a peer acts on its silence
Both are read from what the vehicles recorded, replayed by fresh brains. Bandwidth is what a
vehicle heard, all packets; CPU is utime + stime of a vehicle's process.

Recommended: of those with fewer false alarms than the base, beyond chance, that notice no later, the
ones that notice first; of these the one with the fewest false alarms, then the least bandwidth,
then CPU. If there is none: the one with the fewest false alarms of all.
Base and recommended are then run once more, with seeds of their own.

The folder --out gets recommended.xml, evidence.json, report.html, pictures as SVG where gnuplot is
installed, and the evidence of every trial at once: the same command continues where it was cut off.

Examples
  fleetctl qos tune --impair loss=0.1,delay=20ms,jitter=5ms
  fleetctl qos tune --quick --out try && fleetctl run four_way --qos try/recommended.xml
  fleetctl qos tune --qos mine.xml --impair burst=0.05,burst_length=4 --vehicles 8 --fleets 1

Exit code: 0 better than the base, and verified; 1 not so, or interrupted; 2 could not run.
)";

std::string CheckTrialImpairment(const std::string& text) {
  const std::string wrong = CheckImpairment(text);
  if (wrong.empty() && ParseImpairment(text).impairment.seed) {
    return "seed: every trial has one of its own; leave it out, and give --seed";
  }
  return wrong;
}

}  // namespace

void AddQosTune(CLI::App* qos, int* exit_code) {
  const auto options = std::make_shared<QosTuneOptions>();
  CLI::App* verb = qos->add_subcommand("tune", "Search better beacon QoS on real vehicles");
  verb->footer(kTuneFooter);
  verb->add_option("--impair", options->impair, "What every vehicle receives through, as of run")
      ->check(CheckTrialImpairment)
      ->capture_default_str();
  verb->add_option("--vehicles", options->vehicles, "Of each fleet")
      ->check(CLI::Range(2U, 64U))
      ->capture_default_str();
  verb->add_option("--qos,--base", options->base,
                   "What is tuned: a file or the name of a shipped set; without it the default")
      ->check(CheckNotEmpty);
  verb->add_option("--out", options->out, "Folder of the search")
      ->check(CheckNotEmpty)
      ->capture_default_str();
  verb->add_option("--fleets", options->fleets, "Fleets that run side by side")
      ->default_str("two a core")
      ->check(CLI::Range(1U, 64U));
  verb->add_option("--seed", options->seed, "Of losses and kills")
      ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()))
      ->capture_default_str();
  verb->add_flag("--quick", options->quick, "Fewer candidates and trials: under 3 minutes");
  AddTimeFlag(verb, "--trial-duration,--trial-seconds", &options->trial_s,
              "Observed while all are alive; 20s, with --quick 12s");
  verb->add_option("--candidates", options->candidates, "At most so many, the base among them")
      ->check(CLI::Range(1U, 1000U));
  verb->add_option("--verify-trials", options->verify_trials,
                   "Of base and recommended each; 6, with --quick 5")
      ->check(CLI::Range(1U, 1000U));
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, exit_code] { *exit_code = RunQosTune(*options); });
}

}  // namespace giveway::fleetctl

#include <algorithm>
#include <memory>

#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/stopwatch/stopwatch.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kStopwatchFooter = R"(
Starts fleets of real processes, injects faults into up to half of each at once, and measures the time
until each peer reports in its log that it noticed, by each mechanism: age of the newest beacon, DEADLINE,
LIVELINESS, participant lease, leave notice (good_bye). --table shows which must notice which fault, and within what time.

Faults
  kill     kill -9
  pause    SIGSTOP
  exit     SIGTERM
  hung     the control loop stops, other threads run
  cut      no packet between it and its peers, either way
  one_way  its packets are lost, it hears its peers

Examples
  fleetctl stopwatch --quick
  fleetctl stopwatch --trials 200 --json > stopwatch.json
  fleetctl stopwatch --faults kill,hung --qos mine.xml
  fleetctl stopwatch --table

Exit code: 0 every promise was kept; 1 one was broken, or not every trial was made (interrupted); 2 none could
be made.
)";

// Above 32 vehicles the code sets another lease; one place stays free.
constexpr std::uint32_t kMostVehicles = 31;
constexpr std::uint32_t kMostTrials = 100'000;
constexpr std::uint32_t kMostFleets = 16;
constexpr std::uint32_t kQuickTrials = 10;

Fault ParseFault(const std::string& name) {
  if (const auto fault = FaultNamed(name)) return *fault;
  throw CLI::ValidationError("--faults",
                             "must be kill, pause, exit, hung, cut or one_way, with commas "
                             "between them, not '" +
                                 name + "'");
}

// In the order of the table, each once; all of them if none is named.
std::vector<Fault> ParseFaults(const std::vector<std::string>& names) {
  std::vector<Fault> faults;
  for (const std::string& name : names) faults.push_back(ParseFault(name));
  for (std::size_t i = 0; names.empty() && i < kFaults; ++i)
    faults.push_back(static_cast<Fault>(i));
  std::ranges::sort(faults);
  faults.erase(std::unique(faults.begin(), faults.end()), faults.end());
  return faults;
}

struct Given {
  StopwatchOptions options;
  std::vector<std::string> faults;
  bool quick = false;
};

void AddFlags(CLI::App* verb, Given* given) {
  StopwatchOptions* const options = &given->options;
  verb->add_option("--vehicles", options->vehicles, "Of each fleet; half of them observe")
      ->check(CLI::Range(2U, kMostVehicles))
      ->capture_default_str();
  CLI::Option* trials = verb->add_option("--trials", options->trials, "Of each fault")
                            ->check(CLI::Range(1U, kMostTrials))
                            ->capture_default_str();
  verb->add_option("--faults", given->faults, "Which ones; without it all")->delimiter(',');
  verb->add_option("--fleets", options->fleets, "At a time, each in a domain of its own")
      ->check(CLI::Range(1U, kMostFleets))
      ->capture_default_str();
  verb->add_option("--qos", options->qos_file,
                   "Fast DDS XML profiles: a file, or a shipped set; without it the default")
      ->envname("GIVEWAY_QOS");
  AddInterfaceFlag(verb, &options->interface);
  verb->add_option("--seed", options->seed, "Of which vehicle is faulted when")
      ->capture_default_str();
  verb->add_option("--logs", options->logs_folder, "Keep the log of every process in this folder");
  verb->add_flag("--quick", given->quick,
                 "10 trials of each fault: under 2 minutes with 8 vehicles")
      ->excludes(trials);
  CLI::Option* const table = verb->add_flag(
      "--table", options->table, "Only print what must notice which fault within what time");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else")
      ->excludes(table);
}

}  // namespace

void AddStopwatchVerb(CLI::App* fleetctl, int* exit_code) {
  const auto given = std::make_shared<Given>();
  CLI::App* verb =
      fleetctl->add_subcommand("stopwatch", "How long until peers notice that a vehicle is gone?");
  verb->footer(kStopwatchFooter);
  AddFlags(verb, given.get());
  verb->callback([given, exit_code] {
    given->options.faults = ParseFaults(given->faults);
    if (given->quick) given->options.trials = kQuickTrials;
    *exit_code = RunStopwatch(given->options);
  });
}

}  // namespace giveway::fleetctl

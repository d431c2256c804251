#include <limits>
#include <memory>
#include <string>

#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/faults/faults.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kExpandFooter = R"(
Prints the concrete faults that FILE makes with this seed, duration and fleet: target, kind, time and
duration. Real and virtual runs carry out this list. It is a fault file itself, of `at` rules only, which
expands to itself. The vehicles have the ids 1 to N. It is the list of a soak of N vehicles, but for what that
refuses or leaves out; --warm-up and --healing make another. FILE is a path, or the name of a shipped file:
calm, radio_storm, flaky_hardware, everything; idl/faults.proto documents each field. Nothing is
started.

Examples
  fleetctl faults expand everything --seed 1 --duration 30m --vehicles 20 > list.textproto
  fleetctl faults expand list.textproto --duration 30m --vehicles 20      # the same list
  fleetctl faults expand radio_storm --duration 3m --vehicles 8 --text
  fleetctl faults expand calm --duration 3m --vehicles 8 --json | jq '.faults[].kind'

Exit code: 0 expanded; 2 the file is wrong, or does not fit the fleet or the duration.
)";

constexpr const char* kListFooter = R"(
Of each kind of fault: what carries it out, whether it takes `for_s`, its possible targets, and its
parameters with default and range.

Examples
  fleetctl faults list
  fleetctl faults list --json | jq -r '.[] | select(.virtual).kind'

Exit code: 0 shown, 2 could not run.
)";

constexpr const char* kFaultsFooter = R"(
Examples
  fleetctl faults list
  fleetctl faults expand everything --seed 1 --duration 30m --vehicles 20

More: fleetctl faults expand --help
)";

void AddExpand(CLI::App* group, int* exit_code) {
  const auto options = std::make_shared<FaultsOptions>();
  CLI::App* verb = group->add_subcommand("expand", "The concrete faults that a fault file makes");
  verb->footer(kExpandFooter);
  verb->add_option("FILE", options->file, "A fault file, or the name of a shipped one")->required();
  verb->add_option("--seed", options->seed, "Of all that is drawn")
      ->capture_default_str()
      ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()));
  AddDurationFlag(verb, "--duration", &options->duration_s, "Of the run, such as 90s, 30m, 8h, 2d")
      ->required();
  verb->add_option("--vehicles", options->vehicles, "Fleet size")
      ->required()
      ->check(CLI::Range(1U, kMostReckonedWith));
  AddDurationFlag(verb, "--warm-up", &options->warm_up_s, "No random fault starts before it")
      ->default_str("10s and 0.5s a vehicle, a quarter of --duration at most");
  AddDurationFlag(verb, "--healing", &options->healing_s,
                  "All faults are over so long before the end")
      ->default_str("20s, a quarter of --duration at most");
  auto* text = verb->add_flag("--text", options->text, "Print a line a fault, for people");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else")
      ->excludes(text);
  verb->callback([options, exit_code] { *exit_code = RunFaultsExpand(*options); });
}

void AddList(CLI::App* group, int* exit_code) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* verb = group->add_subcommand("list", "The kinds of faults there are");
  verb->footer(kListFooter);
  verb->add_flag("--json", *json, "Print one JSON array on stdout and nothing else");
  verb->callback([json, exit_code] { *exit_code = RunFaultsList(*json); });
}

}  // namespace

void AddFaultsVerb(CLI::App* fleetctl, int* exit_code) {
  CLI::App* verb =
      fleetctl->add_subcommand("faults", "What can go wrong, and what a file makes of it");
  verb->require_subcommand(1);
  verb->footer(kFaultsFooter);
  AddExpand(verb, exit_code);
  AddList(verb, exit_code);
}

}  // namespace giveway::fleetctl

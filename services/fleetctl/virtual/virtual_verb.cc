#include <memory>
#include <string>

#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/virtual/virtual.h"
#include "services/fleetctl/virtual/virtual_flags.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kVirtualFooter = R"(
SCENARIO is a scenario file, the name of a shipped one, or a generator:
crossing, roundabout, corridor, swarm, merge, convoy, warehouse,
door, one_lane, antipodal, parking, shared_goal, mixed_yard.
Every seed draws its own value of a range LO..HI.

Examples
  fleetctl virtual crossing --seeds 1..200 --vehicles 6 --loss 5
  fleetctl virtual swarm --seeds 1..10000 --vehicles 2..50 --loss 0..20 --jobs 2 --json
  fleetctl virtual parking --seeds 1..20 --vehicles 4..12 --fleet mixed --crashes 0
  fleetctl virtual fleet_200 --seed 1 --mcap run.mcap && fleetctl replay run.mcap
  fleetctl virtual swarm --seed 17 --vehicles 12 --picture swarm.svg --trace swarm.tsv

Exit code: 0 passed, 1 failed or interrupted, 2 could not run.
)";

}  // namespace

void AddVirtualVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<VirtualOptions>();
  CLI::App* verb = fleetctl->add_subcommand(
      "virtual", "Run a scenario in virtual time, many times over, and check the invariants");
  verb->footer(kVirtualFooter);
  AddCaseFlags(verb, &options->made_by);
  const auto take_seeds = [options](const std::string& text) {
    options->seeds = WholesOf("--seeds", text, 0, 4294967295.0);
  };
  CLI::Option* seeds =
      verb->add_option_function<std::string>("--seeds", take_seeds, "LO..HI; default 1..100");
  CLI::Option* seed = verb->add_option_function<std::string>(
      "--seed",
      [options](const std::string& text) {
        options->seeds = WholesOf("--seed", text, 0, 4294967295.0);
        if (options->seeds.low == options->seeds.high) return;
        throw CLI::ValidationError("--seed", "must be one number; --seeds takes LO..HI");
      },
      "This one alone");
  seed->excludes(seeds);
  verb->add_option("--jobs", options->jobs, "Runs at a time; default 1")
      ->check(CLI::Range(1U, 1024U));
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->add_option("--picture", options->shown.picture, "Draw the run of --seed as SVG")
      ->needs(seed);
  verb->add_option("--trace", options->shown.trace, "Write every tick of the run of --seed")
      ->needs(seed);
  verb->add_option("--mcap", options->shown.mcap,
                   "Record the run of --seed, for fleetctl replay and other tools")
      ->check(CheckRecordingName)
      ->needs(seed);
  verb->callback([options, exit_code] { *exit_code = RunVirtual(*options); });
}

}  // namespace giveway::fleetctl

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "services/app/flags.h"
#include "services/fleetctl/verbs.h"
#include "services/fleetctl/virtual.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kFooter = R"(
SCENARIO is a scenario file, the name of a shipped one, or a generator:
crossing, roundabout, corridor, swarm, merge, convoy, warehouse.
A range LO..HI is drawn from anew by every seed.

Examples
  fleetctl virtual crossing --seeds 1..200 --vehicles 6 --loss 5
  fleetctl virtual swarm --seeds 1..10000 --vehicles 2..50 --loss 0..20 --jobs 2 --json
  fleetctl virtual swarm --seed 17 --vehicles 12 --picture swarm.svg --trace swarm.tsv

Exit code: 0 passed, 1 failed or interrupted, 2 could not run.
)";

// "LO..HI", or "N" for both.
std::optional<NumberRange> ParseRange(const std::string& text) {
  const std::size_t dots = text.find("..");
  const auto number = [](const std::string& part) -> std::optional<double> {
    std::size_t used = 0;
    try {
      const double value = std::stod(part, &used);
      if (used == part.size() && std::isfinite(value)) return value;
    } catch (const std::exception&) {
    }
    return std::nullopt;
  };
  const auto low = number(text.substr(0, dots));
  const auto high = dots == std::string::npos ? low : number(text.substr(dots + 2));
  if (!low || !high || *low > *high) return std::nullopt;
  return NumberRange{*low, *high};
}

NumberRange NumbersOf(const std::string& flag, const std::string& text, double least, double most) {
  const auto range = ParseRange(text);
  if (range && range->low >= least && range->high <= most) return *range;
  throw CLI::ValidationError(flag, CLI::detail::to_string(least) + " to " +
                                       CLI::detail::to_string(most) +
                                       ", a number or LO..HI, not '" + text + "'");
}

WholeRange WholesOf(const std::string& flag, const std::string& text, double least, double most) {
  const NumberRange range = NumbersOf(flag, text, least, most);
  const bool whole = range.low == std::floor(range.low) && range.high == std::floor(range.high);
  if (!whole) throw CLI::ValidationError(flag, "must be whole, not '" + text + "'");
  return {static_cast<std::uint32_t>(range.low), static_cast<std::uint32_t>(range.high)};
}

// CLI11's own range check lets "nan" pass.
auto Between(double least, double most) {
  return [=](const std::string& text) -> std::string {
    const auto range = ParseRange(text);
    if (range && range->low == range->high && range->low >= least && range->high <= most) return {};
    return "must be a number from " + CLI::detail::to_string(least) + " to " +
           CLI::detail::to_string(most) + ", not '" + text + "'";
  };
}

void AddRadioFlags(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option_function<std::string>(
      "--loss",
      [made_by](const std::string& text) {
        made_by->loss_percent = NumbersOf("--loss", text, 0, 99);
      },
      "Percent of beacons lost, or LO..HI");
  verb->add_flag("--burst", made_by->burst, "The loss comes in bursts of five beacons on average");
  verb->add_option("--delay", made_by->delay_ms, "Milliseconds a beacon is under way")
      ->check(Between(0, 1000));
  verb->add_option("--jitter", made_by->jitter_ms, "Milliseconds it may take longer")
      ->check(Between(0, 1000));
  verb->add_option("--reorder", made_by->reorder_percent, "Percent held back and overtaken")
      ->check(Between(0, 100));
  verb->add_option("--duplicate", made_by->duplicate_percent, "Percent heard twice")
      ->check(Between(0, 100));
}

void AddFaultFlags(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option("--crashes", made_by->crashes, "Vehicles that die in each run")
      ->check(CLI::Range(0U, 1000U));
  verb->add_option("--pauses", made_by->pauses, "Processes that stand still for a while")
      ->check(CLI::Range(0U, 1000U));
  verb->add_option("--restarts", made_by->restarts, "Processes that start anew")
      ->check(CLI::Range(0U, 1000U));
}

void AddCaseFlags(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option("SCENARIO", made_by->scenario, "A scenario file, a shipped one, or a generator")
      ->required();
  verb->add_option_function<std::string>(
      "--vehicles",
      [made_by](const std::string& text) {
        made_by->vehicles = WholesOf("--vehicles", text, 2, 1000);
      },
      "Of a generator, or LO..HI; default 6");
  verb->add_option_function<std::string>(
      "--behaviour",
      [made_by](const std::string& name) {
        made_by->behaviour = app::BehaviourNamed(name);
        if (!made_by->behaviour) throw CLI::ValidationError("--behaviour", "unknown: " + name);
      },
      "Every vehicle drives so");
  AddRadioFlags(verb, made_by);
  AddFaultFlags(verb, made_by);
}

}  // namespace

void AddVirtualVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<VirtualOptions>();
  CLI::App* verb = fleetctl->add_subcommand(
      "virtual", "Run a scenario in virtual time, many times over, and check the invariants");
  verb->footer(kFooter);
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
        options->seeds.high = options->seeds.low;
      },
      "This one alone");
  seed->excludes(seeds);
  verb->add_option("--jobs", options->jobs, "Runs at a time")->check(CLI::Range(1U, 1024U));
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->add_option("--picture", options->picture_file, "Draw the run of --seed as SVG")
      ->needs(seed);
  verb->add_option("--trace", options->trace_file, "Write every tick of the run of --seed")
      ->needs(seed);
  verb->callback([options, exit_code] { *exit_code = RunVirtual(*options); });
}

}  // namespace giveway::fleetctl

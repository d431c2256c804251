#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/virtual/shrink.h"
#include "services/fleetctl/virtual/virtual_flags.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kShrinkFooter = R"(
Takes the flags of `fleetctl virtual` with which the seed failed. Leaves out vehicles, faults, walls,
obstacles, doors, signal heads and what goes wrong on the radio, one after the other, as long as the
same invariant breaks: the one of --invariant, or the first. What is left of --faults is written next
to the scenario, as NAME_SEED.faults.textproto.

Example
  fleetctl shrink crossing --vehicles 4 --behaviour lecture_printed --seed 1
  fleetctl shrink door --fleet mixed --seed 1411 --invariant contact

Exit code: 1 the run breaks an invariant and the file is written, 0 it breaks none, 2 could not run,
or it only misses what its scenario expects.
)";

std::vector<std::string> InvariantNames() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < sim::kInvariantCount; ++i) {
    names.emplace_back(sim::Name(static_cast<sim::Invariant>(i)));
  }
  return names;
}

}  // namespace

void AddShrinkVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<ShrinkOptions>();
  CLI::App* verb = fleetctl->add_subcommand(
      "shrink", "Reduce a failing virtual run to the smallest that still fails");
  verb->footer(kShrinkFooter);
  AddCaseFlags(verb, &options->made_by);
  verb->add_option("--seed", options->seed, "The seed that fails")
      ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()))
      ->required();
  verb->add_option_function<std::string>(
          "--invariant",
          [options](const std::string& name) { options->invariant = sim::InvariantNamed(name); },
          "The invariant that must still break, as contact or progress; default the first that "
          "breaks")
      ->check(CLI::IsMember(InvariantNames()).description(""));
  verb->add_option("--out", options->out_file, "The file; default NAME_SEED.textproto");
  verb->callback([options, exit_code] { *exit_code = RunShrink(*options); });
}

}  // namespace giveway::fleetctl

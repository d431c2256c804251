// Any text as a scenario file: either a scenario that keeps every rule, in which a fleet can start
// to drive, or problems that a person can read.
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/types/check.h"
#include "sim_world/virtual/virtual_fleet.h"
#include "tests/fuzz/outputs.h"
#include "tests/fuzz/scenario_rules.h"
#include "tests/fuzz/target.h"
#include "tests/fuzz/text_input.h"

namespace giveway::fuzz {
namespace {

// The first ticks of an accepted scenario: no vehicle publishes what its peers must refuse.
void CheckDrives(const Scenario& scenario) {
  constexpr std::size_t kLargest = 6;
  constexpr int kTicks = 4;
  if (scenario.vehicles.size() > kLargest) return;
  sim::VirtualFleet fleet(scenario);
  bool running = true;
  for (int tick = 0; tick < kTicks && running; ++tick) {
    running = fleet.Advance();
    for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
      CheckOutputs(fleet.OutputsOf(i), scenario.vehicles[i]);
      GIVEWAY_CHECK(fleet.Brain(i).State().counters.beacons.Rejected() == 0, i);
    }
  }
}

}  // namespace

std::vector<Input> Samples() {
  return TextFilesOf({GIVEWAY_SCENARIOS, GIVEWAY_BAD_SCENARIOS, GIVEWAY_FUZZ_SCENARIOS});
}

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace giveway;
  static fuzz::MemoryFile file;
  file.Hold(data, size);
  try {
    const Scenario scenario = LoadScenario(file.Path(), {});
    fuzz::CheckScenario(scenario);
    fuzz::CheckDrives(scenario);
  } catch (const InputError& error) {
    fuzz::CheckProblems(error);
  }
  return 0;
}

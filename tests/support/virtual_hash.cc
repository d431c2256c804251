// Prints the state hash of a scenario run in virtual time: what a real run in lockstep must end in.
//   virtual_hash SCENARIO SEED
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "services/config/scenario_file.h"
#include "sim_world/virtual/virtual_fleet.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: virtual_hash SCENARIO SEED\n", stderr);
    return 2;
  }
  try {
    const auto seed = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
    giveway::sim::VirtualFleet fleet(giveway::LoadScenario(argv[1], {.seed = seed}));
    fleet.Finish();
    std::printf("%016llx\n", static_cast<unsigned long long>(fleet.World().Figures().state_hash));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

// Prints the state hash of a scenario run in virtual time, in which a real run in lockstep must
// end, and to stderr how many faults of the world started and ended.
//   virtual_hash SCENARIO SEED [FAULTS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "services/config/faults/faults_file.h"
#include "services/config/scenario_file.h"
#include "sim_world/virtual/virtual_fleet.h"

namespace {

giveway::faults::Schedule ScheduleOf(const char* file, const giveway::Scenario& scenario) {
  std::vector<giveway::VehicleId> ids;
  for (const giveway::VehicleOptions& vehicle : scenario.vehicles) ids.push_back(vehicle.id);
  return giveway::LoadAndExpandFaults(
             file, {.seed = scenario.seed, .duration_s = scenario.duration_s, .healing_s = 0}, ids)
      .schedule;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::fputs("usage: virtual_hash SCENARIO SEED [FAULTS]\n", stderr);
    return 2;
  }
  try {
    const auto seed = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
    const giveway::Scenario scenario = giveway::LoadScenario(argv[1], {.seed = seed});
    giveway::sim::VirtualPlan plan{.seed = seed};
    if (argc == 4) plan.schedule = ScheduleOf(argv[3], scenario);
    giveway::sim::VirtualFleet fleet(scenario, plan);
    fleet.Finish();
    std::printf("%016llx\n", static_cast<unsigned long long>(fleet.World().Figures().state_hash));
    const auto count = [&](giveway::EventKind kind) {
      return std::ranges::count(fleet.History(), kind, &giveway::WorldEvent::kind);
    };
    std::fprintf(stderr, "%td started, %td over\n", count(giveway::EventKind::kFaultBegan),
                 count(giveway::EventKind::kFaultOver));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

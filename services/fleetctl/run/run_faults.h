// What `fleetctl run` carries out of a scenario's own list of faults: those of the world, those of
// what vehicles hear, and kills. Everything else needs the supervisor of a soak, and is refused.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/faults/fault_file.h"
#include "services/types/impairment.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

struct RunFaults {
  faults::Schedule worlds;
  std::map<VehicleId, Impairment> heard;  // of every vehicle, or empty: as without faults
  std::vector<PlannedFault> kills;        // by time
};

// `own` is expanded with the scenario's seed and duration. `always` is what the vehicles hear
// anyway: rules of faults come after it, so they hold while they last. Throws InputError for every
// rule that is refused.
RunFaults FaultsOfRun(const faults::FaultFile& own, const Scenario& scenario,
                      std::span<const VehicleId> fleet, const Impairment& always);

}  // namespace giveway::fleetctl

// Which lists of faults a soak carries out: the scenario's own, that of --faults, or both as one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/faults/fault_file.h"
#include "services/fleetctl/soak/verb/soak_options.h"

namespace giveway::fleetctl {

struct SoakFaults {
  std::vector<faults::FaultFile> sources;
  std::string flag;  // --faults of the line that repeats the soak; empty: without it
  std::string name;  // of both, for people and comparisons
};

// `own` is the scenario's list. Where it has none, and --faults is not given, the faults are the
// shipped ones of `calm`. Throws InputError.
SoakFaults FaultsOf(const SoakOptions& options, const std::optional<faults::FaultFile>& own);

}  // namespace giveway::fleetctl

// The verb `fleetctl soak`: drives a fleet under a seeded schedule of faults, checks every promise,
// and ends with a verdict and a report. Values in; the exit code out.
#pragma once

#include "services/fleetctl/soak/verb/soak_options.h"

namespace giveway::fleetctl {

// 0 passed; 1 failed or interrupted; 2 not run. Throws InputError, OutputError, DomainError,
// LinkError, StartError.
int Soak(const SoakOptions& options);

}  // namespace giveway::fleetctl

// The verb `fleetctl run`: starts a world and one process per vehicle on this host, supervises
// them, and prints the verdict. Values in; the exit code out.
#pragma once

#include "services/fleetctl/run/run_options.h"

namespace giveway::fleetctl {

// 0 passed, 1 failed or interrupted, 2 could not run.
int Run(const RunOptions& options);

}  // namespace giveway::fleetctl

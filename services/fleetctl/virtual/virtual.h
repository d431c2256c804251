// The verb `fleetctl virtual`: many runs of a scenario in virtual time, judged by the invariants;
// or one of them shown. Values in; the exit code out.
#pragma once

#include <cstdint>

#include "services/fleetctl/virtual/virtual_case.h"
#include "services/fleetctl/virtual/virtual_show.h"

namespace giveway::fleetctl {

struct VirtualOptions {
  CaseOptions made_by;
  WholeRange seeds{1, 100};
  std::uint32_t jobs = 1;
  ShownFiles shown;  // of a single seed
  bool json = false;
};

// 0 passed, 1 failed or interrupted, 2 could not run.
int RunVirtual(const VirtualOptions& options);

}  // namespace giveway::fleetctl

// The verb `fleetctl virtual`: many runs of a scenario in virtual time, judged by the invariants;
// or one of them shown. Values in; the exit code out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/fleetctl/virtual/virtual_case.h"

namespace giveway::fleetctl {

struct VirtualOptions {
  CaseOptions made_by;
  WholeRange seeds{1, 100};
  std::uint32_t jobs = 1;
  std::string picture_file;  // of a single seed; empty: none
  std::string trace_file;    // of a single seed; empty: none
  bool json = false;
};

// 0 passed, 1 failed or interrupted, 2 could not run.
int RunVirtual(const VirtualOptions& options);

}  // namespace giveway::fleetctl

// The verb `fleetctl shrink`: reduces a failing virtual run to a small one that still fails, and
// writes it as a scenario file, and the rest of its fault schedule as a fault file. Values in; the
// exit code out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/fleetctl/virtual/virtual_case.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::fleetctl {

struct ShrinkOptions {
  CaseOptions made_by;
  std::uint32_t seed = 1;
  std::optional<sim::Invariant> invariant;  // that must still break; absent: the first that breaks
  std::string out_file;  // empty: NAME_SEED.textproto; faults: with .faults before the ending
};

// 1 if the run fails and the file is written, 0 if it does not fail, 2 if it could not run.
int RunShrink(const ShrinkOptions& options);

// The flags of `fleetctl virtual` that replay the plan on the file of the scenario: empty if
// nothing goes wrong and nothing is drawn. The schedule, if there is one, is read from
// `fault_file`.
std::string ReplayFlags(const VirtualCase& made, const std::string& fault_file);

}  // namespace giveway::fleetctl

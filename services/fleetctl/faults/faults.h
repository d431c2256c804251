// The verb `fleetctl faults`: shows the kinds of faults, and the faults that a file produces.
// Injects none.
#pragma once

#include <cstdint>
#include <string>

#include "services/faults/expand.h"

namespace giveway::fleetctl {

struct FaultsOptions {
  std::string file;
  faults::Course course;
  std::uint32_t vehicles = 2;
  bool text = false;
  bool json = false;
};

// Print on stdout and give the exit code. Throw InputError and OutputError.
int RunFaultsExpand(const FaultsOptions& options);
int RunFaultsList(bool json);

}  // namespace giveway::fleetctl

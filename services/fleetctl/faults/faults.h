// The verb `fleetctl faults`: shows the kinds of faults, and the faults that a file produces.
// Injects none.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace giveway::fleetctl {

struct FaultsOptions {
  std::string file;
  std::uint32_t seed = 1;
  double duration_s = 0;
  std::optional<double> warm_up_s;  // absent, here and below: that of a soak
  std::optional<double> healing_s;
  std::uint32_t vehicles = 2;
  bool text = false;
  bool json = false;
};

// Print on stdout and give the exit code. Throw InputError and OutputError.
int RunFaultsExpand(const FaultsOptions& options);
int RunFaultsList(bool json);

}  // namespace giveway::fleetctl

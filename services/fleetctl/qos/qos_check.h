// The verb `fleetctl qos check`: checks profile files against a fleet, and prints the findings.
// Values in; the exit code out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace giveway::fleetctl {

struct QosCheckOptions {
  std::vector<std::string> files;  // paths, or names of shipped sets; none: the shipped default
  std::string compose;             // a compose file: the sets and number of its services
  std::string scenario;            // file or name; empty: two vehicles at 20 Hz
  std::optional<std::int64_t> vehicles;  // instead of the scenario's
  bool partial = false;                  // files need not be complete sets
  bool json = false;
};

// 0 nothing found, 1 warnings only, 2 errors, or it could not run.
int RunQosCheck(const QosCheckOptions& options);

}  // namespace giveway::fleetctl

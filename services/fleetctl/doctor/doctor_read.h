// Reads the facts of this host. The folders may be others of the same shape, for tests.
#pragma once

#include <filesystem>

#include "services/fleetctl/doctor/doctor_facts.h"
#include "services/fleetctl/doctor/doctor_options.h"

namespace giveway::fleetctl {

struct HostFolders {
  std::filesystem::path proc = "/proc";
  std::filesystem::path memory = "/dev/shm";
};

// All but interfaces and clock. Throws InputError if the planned set cannot be read.
HostFacts ReadHost(const DoctorOptions& options, const HostFolders& folders);

// With an echo of multicast tried on those that are meant. Throws LinkError.
std::vector<HostInterface> ReadInterfaces(const std::string& interface);
// Looks at both clocks for a fifth of a second.
ClockFacts ReadClock();

}  // namespace giveway::fleetctl

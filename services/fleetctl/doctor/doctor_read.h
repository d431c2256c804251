// Reads the facts of this host. Tests pass other folders of the same layout.
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

// Also tests for a multicast echo on the selected interfaces. Throws LinkError.
std::vector<HostInterface> ReadInterfaces(const std::string& interface);
// Compares both clocks for a fifth of a second.
ClockFacts ReadClock();

}  // namespace giveway::fleetctl

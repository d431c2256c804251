// Reads the files of Fast DDS in a shared memory folder, and which processes use them. Tests pass
// other folders of the same layout. If no user of a file is found, requests exclusive access to it
// for a moment, which the kernel refuses if another process uses it.
#pragma once

#include <filesystem>

#include "services/fleetctl/doctor/shared_memory.h"

namespace giveway::fleetctl {

SharedMemory ReadSharedMemory(const std::filesystem::path& folder,
                              const std::filesystem::path& proc);

}  // namespace giveway::fleetctl

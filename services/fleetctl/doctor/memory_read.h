// Reads the files of Fast DDS in a shared memory folder, and who uses them. The folders may be
// others of the same shape, for tests. Where no process is seen to use a file it is asked for
// alone, for a moment, which the kernel refuses if another process does.
#pragma once

#include <filesystem>

#include "services/fleetctl/doctor/shared_memory.h"

namespace giveway::fleetctl {

SharedMemory ReadSharedMemory(const std::filesystem::path& folder,
                              const std::filesystem::path& proc);

}  // namespace giveway::fleetctl

// Reads who uses which file of Fast DDS in a shared memory folder, and removes those nobody uses.
// The folders may be others of the same shape, for tests. To learn whether a lock is held it is
// tried for a moment, and only if nobody is seen to hold the file.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "services/fleetctl/shared_memory.h"

namespace giveway::fleetctl {

SharedMemory ReadSharedMemory(const std::filesystem::path& folder,
                              const std::filesystem::path& proc);

// Fills in `users` of the files, and returns the processes that may not be looked into. The
// caller's own process does not count.
std::vector<UnseenProcess> ReadUsers(const std::filesystem::path& proc,
                                     std::vector<MemoryFile>* files);

// The file's facts as they are now, but for `locked` and `users`; nothing if it is no regular file.
std::optional<MemoryFile> ReadMemoryFile(const std::filesystem::path& file);

}  // namespace giveway::fleetctl

// The report folder of a soak, kept for itself as long as this lives: a second soak there, or one
// that resumes it, would overwrite what the first one reads and writes. Of a process that is killed
// the lock is free at once.
#pragma once

#include <string>

#include "services/fleetctl/process/file_descriptor.h"

namespace giveway::fleetctl {

class FolderLock {
 public:
  // By FOLDER/.lock, which stays there. `flag` named the folder. Throws InputError if another soak
  // has it, OutputError if the file cannot be made.
  FolderLock(const std::string& folder, const std::string& flag);

 private:
  FileDescriptor lock_;  // closed on exec: no child outlives the supervisor with it
};

}  // namespace giveway::fleetctl

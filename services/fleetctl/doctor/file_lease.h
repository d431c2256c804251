// Asks the kernel whether any process has a file open or mapped: a write lease is granted only to
// the sole user of a file (fcntl(2), F_SETLEASE). Unlike /proc this covers processes of other users
// and of other namespaces, and it stays true: a process that opens the file meanwhile waits until
// the lease ends.
#pragma once

#include <cstdint>
#include <filesystem>

#include "services/fleetctl/process/file_descriptor.h"

namespace giveway::fleetctl {

class FileLease {
 public:
  enum class Answer : std::uint8_t {
    kAlone,    // the lease is ours
    kUsed,     // another process has it open or mapped
    kUnknown,  // only its owner and root may ask, and not on every file system
  };

  explicit FileLease(const std::filesystem::path& file);

  Answer Outcome() const { return outcome_; }
  const FileDescriptor& File() const { return file_; }

 private:
  FileDescriptor file_;  // closing it ends the lease
  Answer outcome_ = Answer::kUnknown;
};

}  // namespace giveway::fleetctl

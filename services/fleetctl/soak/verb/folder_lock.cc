#include "services/fleetctl/soak/verb/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "services/config/problem.h"
#include "services/fleetctl/output/output_file.h"

namespace giveway::fleetctl {

FolderLock::FolderLock(const std::string& folder, const std::string& flag) {
  const std::string path = (std::filesystem::path(folder) / ".lock").string();
  lock_ = FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (!lock_.IsOpen()) throw OutputError("cannot open " + path + ": " + std::strerror(errno));
  // Where the file system has no locks, nothing is kept.
  if (::flock(lock_.Get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  throw InputError({{.file = folder,
                     .field = flag,
                     .value = folder,
                     .message = "another soak that still runs has this folder",
                     .remedy = "wait for its end, or take another folder"}});
}

}  // namespace giveway::fleetctl

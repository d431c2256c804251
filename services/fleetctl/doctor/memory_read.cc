#include "services/fleetctl/doctor/memory_read.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <utility>

#include "services/fleetctl/doctor/file_lease.h"
#include "services/fleetctl/process/file_descriptor.h"
#include "services/fleetctl/survey/why_proc.h"
#include "services/fleetctl/survey/why_proc_text.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kBlockBytes = 512;  // of st_blocks, whatever the file system

using FileKey = std::pair<std::uint64_t, std::uint64_t>;  // device, inode

std::map<FileKey, MemoryFile*> ByKey(std::vector<MemoryFile>* files) {
  std::map<FileKey, MemoryFile*> by_key;
  for (MemoryFile& file : *files) {
    by_key[{file.identity.device, file.identity.inode}] = &file;
  }
  return by_key;
}

// What one process does with the files.
class ProcessUse {
 public:
  ProcessUse(const fs::path& process, int pid, const std::map<FileKey, MemoryFile*>& files)
      : process_(process), pid_(pid), files_(files) {}

  // False if either list may not be read.
  bool Maps() {
    std::ifstream maps(process_ / "maps");
    if (!maps) return false;
    for (std::string line; std::getline(maps, line);) {
      if (const auto mapped = ParseMapped(line)) Uses({mapped->device, mapped->inode});
    }
    return true;
  }
  bool Holds() {
    std::error_code error;
    fs::directory_iterator open(process_ / "fd", error);
    if (error) return false;
    for (; open != fs::directory_iterator(); open.increment(error)) {
      struct stat held {};
      if (::stat(open->path().c_str(), &held) == 0) {
        Uses({held.st_dev, held.st_ino});
      } else if (errno == EACCES) {
        return false;
      }
    }
    return true;
  }

 private:
  void Uses(const FileKey& key) {
    const auto found = files_.find(key);
    if (found == files_.end()) return;
    std::vector<int>& users = found->second->users;
    if (users.empty() || users.back() != pid_) users.push_back(pid_);
  }

  const fs::path& process_;
  const int pid_;
  const std::map<FileKey, MemoryFile*>& files_;
};

// Whether another process holds the lock; also true if it may not be tried.
bool IsLocked(const fs::path& file) {
  const FileDescriptor lock(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!lock.IsOpen()) return errno != ENOENT;
  // Exclusively: the listeners of a shared port hold a shared lock.
  return ::flock(lock.Get(), LOCK_EX | LOCK_NB) != 0;
}

void AskKernel(const fs::path& folder, MemoryFile* file) {
  if (!file->users.empty()) return;
  const FileLease::Answer said = FileLease(folder / file->name).Outcome();
  if (said != FileLease::Answer::kUnknown) {
    file->held = said == FileLease::Answer::kUsed;
  } else if (PartOf(file->name) == MemoryPart::kLock) {
    file->locked = IsLocked(folder / file->name);
  }
}

// What can be read of the file itself; nullopt if it is not a regular file.
std::optional<MemoryFile> ReadMemoryFile(const fs::path& file) {
  struct stat found {};
  if (::lstat(file.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  MemoryFile read;
  read.name = file.filename().string();
  read.identity = {found.st_dev, found.st_ino};
  read.bytes = static_cast<std::uint64_t>(found.st_blocks) * kBlockBytes;
  read.user = found.st_uid;
  read.mode = found.st_mode & 07777U;
  read.age_s = std::max<std::int64_t>(std::time(nullptr) - found.st_mtime, 0);
  return read;
}

// Fills in `users`, and returns the processes that may not be inspected. Ignores our own process.
std::vector<UnseenProcess> ReadUsers(const fs::path& proc, std::vector<MemoryFile>* files) {
  std::vector<UnseenProcess> unseen;
  const auto by_key = ByKey(files);
  for (const int pid : ProcessIds(proc)) {
    if (pid == ::getpid()) continue;
    const fs::path process = proc / std::to_string(pid);
    ProcessUse use(process, pid, by_key);
    const bool maps = use.Maps();
    const bool holds = use.Holds();
    if (maps && holds) continue;
    // Kernel threads and ended processes have no command line.
    struct stat owner {};
    if (ReadWholeFile(process / "cmdline").value_or("").empty()) continue;
    if (::stat(process.c_str(), &owner) != 0) continue;
    unseen.push_back({pid, owner.st_uid});
  }
  return unseen;
}

}  // namespace

SharedMemory ReadSharedMemory(const fs::path& folder, const fs::path& proc) {
  SharedMemory memory;
  memory.folder = folder.string();
  struct statvfs room {};
  if (::statvfs(folder.c_str(), &room) == 0) {
    memory.total_bytes = static_cast<std::uint64_t>(room.f_blocks) * room.f_frsize;
    memory.free_bytes = static_cast<std::uint64_t>(room.f_bavail) * room.f_frsize;
  }
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (BodyOf(at->path().filename().string()).empty()) continue;
    if (auto file = ReadMemoryFile(at->path())) memory.files.push_back(std::move(*file));
  }
  std::ranges::sort(memory.files, {}, &MemoryFile::name);
  memory.unseen = ReadUsers(proc, &memory.files);
  for (MemoryFile& file : memory.files) AskKernel(folder, &file);
  return memory;
}

}  // namespace giveway::fleetctl

#include "services/fleetctl/doctor/memory_removal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "services/fleetctl/doctor/file_lease.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// The semaphore a participant holds while it opens a port, taken if it is free: a participant that
// opens the port meanwhile waits for us. If its owner died it is not free either, but then no
// process waits for it.
class PortMutex {
 public:
  explicit PortMutex(const fs::path& file) {
    const FileDescriptor open(::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat found {};
    if (!open.IsOpen() || ::fstat(open.Get(), &found) != 0) return;
    if (found.st_size != sizeof(sem_t)) return;
    void* const mapped =
        ::mmap(nullptr, sizeof(sem_t), PROT_READ | PROT_WRITE, MAP_SHARED, open.Get(), 0);
    if (mapped == MAP_FAILED) return;
    semaphore_ = static_cast<sem_t*>(mapped);
    taken_ = ::sem_trywait(semaphore_) == 0;
  }
  ~PortMutex() {
    if (semaphore_ == nullptr) return;
    if (taken_) ::sem_post(semaphore_);
    ::munmap(semaphore_, sizeof(sem_t));
  }
  PortMutex(const PortMutex&) = delete;
  PortMutex& operator=(const PortMutex&) = delete;

 private:
  sem_t* semaphore_ = nullptr;
  bool taken_ = false;
};

// Takes the file for exclusive use; else says why it must stay.
std::string Take(const fs::path& folder, const MemoryFile& was, std::vector<FileLease>* leases) {
  FileLease lease(folder / was.name);
  struct stat now {};
  if (lease.File().IsOpen() && (::fstat(lease.File().Get(), &now) != 0 ||
                                FileIdentity{now.st_dev, now.st_ino} != was.identity)) {
    return "was replaced meanwhile";
  }
  if (lease.Outcome() == FileLease::Answer::kUsed) return "is used again";
  if (lease.Outcome() == FileLease::Answer::kUnknown) return "the kernel does not say who uses it";
  leases->push_back(std::move(lease));
  return {};
}

Removal Unlink(const fs::path& folder, const MemoryFile& file) {
  const fs::path path = folder / file.name;
  return {path.string(), ::unlink(path.c_str()) == 0 ? "" : std::strerror(errno)};
}

class Removing {
 public:
  Removing(const fs::path& folder, std::uint32_t user, std::vector<Removal>* removals)
      : folder_(folder), user_(user), removals_(*removals) {}

  void Group(const MemoryGroup& group) {
    const auto mutex = std::ranges::find(group.files, MemoryPart::kMutex,
                                         [](const MemoryFile& file) { return PartOf(file.name); });
    std::vector<MemoryFile> others = group.files;
    std::erase_if(others,
                  [](const MemoryFile& file) { return PartOf(file.name) == MemoryPart::kMutex; });
    std::string why = WhyNotOurs(group);
    {
      std::optional<PortMutex> held;
      if (why.empty() && mutex != group.files.end()) held.emplace(folder_ / mutex->name);
      Files(others, &why);
    }
    // It guards the others, and goes last and by itself: our own use of it counts as a use.
    if (mutex != group.files.end()) Files({*mutex}, &why);
  }

 private:
  std::string WhyNotOurs(const MemoryGroup& group) const {
    if (group.state == MemoryState::kNotKnown) {
      return "whether another process uses it only its owner and root may ask";
    }
    for (const MemoryFile& file : group.files) {
      if (user_ != 0 && file.user != user_) {
        return fmt::format("belongs to user {}; only root may remove it", file.user);
      }
    }
    return {};
  }
  // All or none of them; `why` they must stay, before or after.
  void Files(const std::vector<MemoryFile>& files, std::string* why) {
    std::vector<FileLease> leases;
    for (const MemoryFile& file : files) {
      if (why->empty()) *why = Take(folder_, file, &leases);
    }
    for (const MemoryFile& file : files) {
      removals_.push_back(why->empty() ? Unlink(folder_, file)
                                       : Removal{(folder_ / file.name).string(), *why});
    }
  }

  const fs::path folder_;
  const std::uint32_t user_;
  std::vector<Removal>& removals_;
};

}  // namespace

std::vector<Removal> RemoveGone(const SharedMemory& memory, std::uint32_t user) {
  std::vector<Removal> removals;
  Removing removing(memory.folder, user, &removals);
  for (const MemoryGroup& group : GroupsOf(memory)) {
    if (group.state != MemoryState::kInUse) removing.Group(group);
  }
  return removals;
}

}  // namespace giveway::fleetctl

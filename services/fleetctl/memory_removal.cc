#include "services/fleetctl/memory_removal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <semaphore.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "services/fleetctl/file_descriptor.h"
#include "services/fleetctl/finding_text.h"
#include "services/fleetctl/memory_read.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// Groups whose locks are held together: each costs descriptors, and each time all processes are
// looked at.
constexpr std::size_t kAtOnce = 100;

// The semaphore a participant holds while it opens a port, taken if it is free: who opens the port
// meanwhile waits for us. It is not free either if its owner died, which ReadUsers tells apart.
class PortMutex {
 public:
  explicit PortMutex(const fs::path& file) {
    const FileDescriptor open(::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW));
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

// One group that is about to go, with all its locks held.
struct Candidate {
  MemoryGroup group;
  std::vector<FileDescriptor> locks;
  std::unique_ptr<PortMutex> mutex;
  std::string left;  // why it must stay
};

std::string WhyNotOurs(const MemoryGroup& group, std::uint32_t user) {
  if (user == 0) return {};
  for (const MemoryFile& file : group.files) {
    if (file.user != user) {
      return fmt::format("belongs to user {}; only root may remove it", file.user);
    }
  }
  return {};
}

void TakeLocks(const fs::path& folder, Candidate* candidate) {
  for (const MemoryFile& file : candidate->group.files) {
    const fs::path path = folder / file.name;
    if (PartOf(file.name) == MemoryPart::kMutex) {
      candidate->mutex = std::make_unique<PortMutex>(path);
    } else if (PartOf(file.name) == MemoryPart::kLock) {
      FileDescriptor lock(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
      if (!lock.IsOpen() || ::flock(lock.Get(), LOCK_EX | LOCK_NB) != 0) {
        candidate->left = "its lock was taken meanwhile";
        return;
      }
      candidate->locks.push_back(std::move(lock));
    }
  }
}

// Behind the locks: the same files, and still nobody who uses them.
void LookAgain(const SharedMemory& memory, const fs::path& proc,
               std::vector<Candidate>* candidates) {
  SharedMemory now;
  for (const Candidate& candidate : *candidates) {
    if (!candidate.left.empty()) continue;
    for (const MemoryFile& was : candidate.group.files) {
      auto file = ReadMemoryFile(fs::path(memory.folder) / was.name);
      if (file && file->identity == was.identity) now.files.push_back(std::move(*file));
    }
  }
  now.unseen = ReadUsers(proc, &now.files);
  std::vector<MemoryGroup> groups = GroupsOf(now);
  for (Candidate& candidate : *candidates) {
    if (!candidate.left.empty()) continue;
    const auto found = std::ranges::find(groups, candidate.group.body, &MemoryGroup::body);
    if (found == groups.end() || found->files.size() != candidate.group.files.size()) {
      candidate.left = "was replaced meanwhile";
    } else if (!found->IsGone()) {
      candidate.left = "is used again";
    }
  }
}

// The body first, so that nobody finds one without a lock; the mutex last, as it guards the others.
void Remove(const fs::path& folder, Candidate* candidate, std::vector<Removal>* removals) {
  std::ranges::stable_sort(candidate->group.files, {},
                           [](const MemoryFile& file) { return PartOf(file.name); });
  for (const MemoryFile& file : candidate->group.files) {
    const fs::path path = folder / file.name;
    const bool gone = candidate->left.empty() && ::unlink(path.c_str()) == 0;
    const std::string why = candidate->left.empty() ? std::strerror(errno) : candidate->left;
    removals->push_back({path.string(), gone ? "" : why});
  }
}

std::string Unseen(const SharedMemory& memory) {
  const UnseenProcess& first = memory.unseen.front();
  return fmt::format(
      "{} process{} may not be looked into and could use it, as pid {} of user {}; "
      "examine as root",
      memory.unseen.size(), memory.unseen.size() == 1 ? "" : "es", first.pid, first.user);
}

}  // namespace

std::vector<Removal> RemoveGone(const SharedMemory& memory, const fs::path& proc,
                                std::uint32_t user) {
  std::vector<Candidate> candidates;
  std::vector<Removal> removals;
  const auto remove = [&] {
    LookAgain(memory, proc, &candidates);
    for (Candidate& candidate : candidates) Remove(memory.folder, &candidate, &removals);
    candidates.clear();
  };
  for (MemoryGroup& group : GroupsOf(memory)) {
    if (group.state == MemoryState::kInUse) continue;
    Candidate candidate;
    candidate.left =
        group.state == MemoryState::kNotKnown ? Unseen(memory) : WhyNotOurs(group, user);
    candidate.group = std::move(group);
    if (candidate.left.empty()) TakeLocks(memory.folder, &candidate);
    candidates.push_back(std::move(candidate));
    if (candidates.size() == kAtOnce) remove();
  }
  remove();
  return removals;
}

}  // namespace giveway::fleetctl

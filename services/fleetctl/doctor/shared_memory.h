// The files Fast DDS keeps in /dev/shm, as values: which belong together, and whether another
// process still uses them. Pure.
//
//   fastrtps_<16 hex digits>   a participant's segment    ..._el  locked as long as its owner lives
//   fastrtps_port<N>           the queue of a port        ..._el, ..._sl  locked by the listener
//   sem.fastrtps_port<N>_mutex held while a port is opened
//   fast_datasharing_...       a writer's samples; without a lock
//
// Fast DDS 3 uses fastdds_ where 2 uses fastrtps_.
// A lock is an flock, so it ends with its process, however that ends. A port is also mapped by
// its senders; they lock their own segment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"

namespace giveway::fleetctl {

enum class MemoryPart : std::uint8_t { kBody, kLock, kMutex };

struct MemoryFile {
  std::string name;
  FileIdentity identity;
  std::uint64_t bytes = 0;   // allocated, not only the file size
  std::uint32_t user = 0;    // who owns it
  std::uint32_t mode = 0;    // permission bits
  std::int64_t age_s = 0;    // since it was last written to or made
  std::optional<bool> held;  // another process has it open or mapped, according to the kernel,
                             // which does not show this to every user
  bool locked = false;       // another process holds its lock; looked at where `held` is not known
  std::vector<int> users;    // those seen to have it open or mapped
};

// A process that may not be inspected, and may have any file open.
struct UnseenProcess {
  int pid = 0;
  std::uint32_t user = 0;
};

struct SharedMemory {
  std::string folder;
  std::uint64_t total_bytes = 0;  // 0: not known
  std::uint64_t free_bytes = 0;
  std::vector<MemoryFile> files;  // those of Fast DDS, by name
  std::vector<UnseenProcess> unseen;
};

// The segment or port a file belongs to: "fastrtps_port7410" of its lock and mutex, too. Empty for
// a file that is not of Fast DDS.
std::string BodyOf(std::string_view name);
MemoryPart PartOf(std::string_view name);

enum class MemoryState : std::uint8_t {
  kInUse,     // locked, mapped or held open
  kNotKnown,  // the kernel does not say, and a process that may not be inspected could use it
  kStale,     // its owner is gone: its lock is free
  kOrphaned,  // unused, and a part is missing: a body without lock, a lock without body
};

// All files that come and go with one segment or port.
struct MemoryGroup {
  std::string body;  // its name, whether or not the file is there
  MemoryState state = MemoryState::kInUse;
  std::vector<MemoryFile> files;

  bool IsGone() const { return state == MemoryState::kStale || state == MemoryState::kOrphaned; }
  std::uint64_t Bytes() const;
};

// By name.
std::vector<MemoryGroup> GroupsOf(const SharedMemory& memory);

// Whether a process of this user could have opened the file for writing, as the library does.
bool MayUse(std::uint32_t user, const MemoryFile& file);

}  // namespace giveway::fleetctl

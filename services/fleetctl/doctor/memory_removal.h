// Removes the files of segments and ports that no process uses any more. They may have changed
// since they were examined: only files that the kernel grants us exclusively are removed, and a
// port only under the lock that participants take to open it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/doctor/shared_memory.h"

namespace giveway::fleetctl {

struct Removal {
  std::string file;  // its path
  std::string left;  // why it was left; empty: it was removed

  friend bool operator==(const Removal&, const Removal&) = default;
};

// `memory` as read from `memory.folder`. Only those with IsGone(), and of those only what `user`
// owns, unless `user` is 0. Those left for another reason than being in use are reported, too.
std::vector<Removal> RemoveGone(const SharedMemory& memory, std::uint32_t user);

}  // namespace giveway::fleetctl

// Whether shared memory still carries what this process sends and receives.
//
// The segment that it sends through: a process that has it open still receives through it once the
// file was deleted. One that starts later finds no file, and receives nothing: the library does not
// create it again.
//
// The ports that it receives at: the library replaces the file of a port that it finds unhealthy,
// such as one of a process that was killed. A process that had the former file open sends into that
// for ever, and the new owner of the port hears nothing of it. Seen with Fast DDS 2.9.1 after
// 10 to 48 kills of one vehicle.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/types/time.h"

namespace giveway::link {

// The targets of the links in a folder such as /proc/self/fd. Empty where it cannot be read.
std::vector<std::string> LinksIn(const std::string& folder);

// Whether one of the files that a process has open is the lock of a segment of its own, and was
// deleted.
bool IsSegmentGone(const std::vector<std::string>& open_files);

// The files of the ports that a process receives at: of each of them it has the lock open.
std::set<std::string> PortsOf(const std::vector<std::string>& open_files);
// Whether a process has a deleted file of one of these names in its memory, by a text such as
// /proc/self/maps.
bool HoldsDeleted(const std::string& maps, const std::set<std::string>& files);

// Of this process; of a participant that uses shared memory.
class SharedMemoryWatch {
 public:
  // Looks at most once a second. Once true it stays so.
  bool IsGone();

 private:
  bool IsPortReplaced(const std::vector<std::string>& open_files);

  SteadyTime next_{0};
  std::set<std::pair<std::string, std::uint64_t>> ports_;  // looked at: file, inode
  bool gone_ = false;
};

}  // namespace giveway::link

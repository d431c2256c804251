// Whether shared memory still carries what this process sends and receives.
//
// The segment that it sends through: a process that has it open still receives through it once the
// file was deleted. One that starts later finds no file, and receives nothing: the library does not
// create it again.
//
// The ports that it receives at, when it starts: the library replaces the files of those whose
// former owner was killed. A process that had such a file open may send into that for ever, and the
// new owner of the port hears nothing of it. Seen with Fast DDS 2.9.1 after 10 to 48 kills of one
// vehicle.
//
// The file of a port whose owner lives is replaced too, where the owner stood still for some
// seconds. That needs nothing: the library first marks the former file as not sound, and so each
// process that has it open turns to the new one when it sends there next, however much later.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
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
// Whether any process does, by a folder such as /proc; as far as this one may read it. A process
// that ends meanwhile is passed over.
bool AnyHoldsDeleted(const std::filesystem::path& processes, const std::set<std::string>& files);

// Of this process; of a participant that uses shared memory.
class SharedMemoryWatch {
 public:
  // Looks at most once a second, at the ports once. Once true it stays so.
  bool IsGone(SteadyTime now);

 private:
  std::optional<SteadyTime> next_;  // look; none before the first
  bool gone_ = false;
};

}  // namespace giveway::link

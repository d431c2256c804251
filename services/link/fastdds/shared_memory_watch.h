// Whether the shared memory that this process sends through is still in the file system. A process
// that has it open still receives through it once the file was deleted. One that starts later finds
// no file, and receives nothing: the library does not create it again.
#pragma once

#include <string>
#include <vector>

#include "services/types/time.h"

namespace giveway::link {

// The targets of the links in a folder such as /proc/self/fd. Empty where it cannot be read.
std::vector<std::string> LinksIn(const std::string& folder);

// Whether one of the files that a process has open is the lock of a segment of its own, and was
// deleted. The library's ports do not count: it creates those again.
bool IsSegmentGone(const std::vector<std::string>& open_files);

// Of this process; of a participant that uses shared memory.
class SharedMemoryWatch {
 public:
  // Looks at most once a second. Once true it stays so.
  bool IsGone();

 private:
  SteadyTime next_{0};
  bool gone_ = false;
};

}  // namespace giveway::link

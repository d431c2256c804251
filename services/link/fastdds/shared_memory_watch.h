// Whether the shared memory that this process sends through is still in the file system. Whoever
// has it open is sent to as before once the file was deleted; whoever comes later finds no file,
// and is never heard: the library makes none again.
#pragma once

#include <string>
#include <vector>

#include "services/types/time.h"

namespace giveway::link {

// The targets of the links in a folder such as /proc/self/fd. Empty where it cannot be read.
std::vector<std::string> LinksIn(const std::string& folder);

// Whether one of the files that a process has open is the lock of a segment that it made itself,
// and was deleted. The library's ports do not count: it makes those anew.
bool IsSegmentGone(const std::vector<std::string>& open_files);

// Of this process.
bool SharedMemoryIsGone();

// For a link that makes itself anew. Where several of a process do, one may be made anew once more,
// as long as another is not.
class SharedMemoryWatch {
 public:
  // False too where it was looked less than a second ago.
  bool IsGone();

 private:
  SteadyTime next_{0};
};

}  // namespace giveway::link

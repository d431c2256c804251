// The file that holds the output of one child. What the disk does not take is lost to the file, and
// is counted and said; the file continues as soon as the disk takes more.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/process/file_descriptor.h"

namespace giveway::fleetctl {

class ChildLog {
 public:
  ChildLog() = default;
  // Says on stderr what was not taken.
  ~ChildLog();
  ChildLog(const ChildLog&) = delete;
  ChildLog& operator=(const ChildLog&) = delete;

  // Makes the file, or empties it. False if it cannot be, and errno says why. Without it nothing is
  // written.
  bool Open(const std::string& path);
  void Append(std::string_view output);
  // The child has ended: says how much is missing.
  void End();
  // Since the last call: that the file cannot be written, once, and at the end what it lacks.
  std::vector<std::string> TakeComplaints();

 private:
  void NoteMissing(std::size_t bytes);

  std::string path_;
  FileDescriptor file_;
  std::uint64_t missing_bytes_ = 0;
  std::vector<std::string> complaints_;
};

}  // namespace giveway::fleetctl

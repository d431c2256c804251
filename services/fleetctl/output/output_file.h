// A file the run will write at its end. Whether it can be written is found out before anything
// starts: that must not be learnt after a minute's run.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace giveway::fleetctl {

// The file cannot be written; what() names it, why, and what to do.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws OutputError unless `path` can be written. Leaves no file behind.
void CheckWritable(const std::string& path);
// Makes the folder if it is missing; throws OutputError unless files can be made in it.
void CheckFolder(const std::string& folder);
// Whole or not at all. Throws OutputError.
void WriteFile(const std::string& path, const std::string& text);
// For files that come after the verdict, which is printed and stands: what cannot be written is
// said on stderr. Returns the exit code: `code`, but at least 1 where a file is missing.
int WriteAfterVerdict(int code, const std::function<void()>& write);

}  // namespace giveway::fleetctl

// A file that the run will write at its end, and what it writes to stdout. Whether a file can be
// written is checked before anything starts, so that a run does not fail at its end.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace giveway::fleetctl {

// The file cannot be written; what() names it, why, and what to do.
class OutputError : public std::runtime_error {
 public:
  // `error` is the errno; 0: none.
  explicit OutputError(const std::string& what, int error = 0)
      : std::runtime_error(what), error_(error) {}

  // Whether the same may succeed later: of a disk that is full or fails, or at a limit of files.
  bool MayPass() const;

 private:
  int error_;
};

// Throws OutputError unless `path` can be written. Leaves no file behind.
void CheckWritable(const std::string& path);
// Creates the folder if it is missing; throws OutputError unless files can be created in it.
void CheckFolder(const std::string& folder);
// Atomically: the complete file or none. Throws OutputError.
void WriteFile(const std::string& path, const std::string& text);
// Whether stdout took all of it. A text longer than stdio's buffer may fail as it is put, and then
// nothing is left to fail as the buffer is flushed.
bool PrintAll(const std::string& text);
// For files that are written after the verdict has been printed: reports on stderr what cannot be
// written. Returns the exit code: `code`, but at least 1 if a file is missing.
int WriteAfterVerdict(int code, const std::function<void()>& write);

}  // namespace giveway::fleetctl

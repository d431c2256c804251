#include "services/fleetctl/process/child_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace giveway::fleetctl {

ChildLog::~ChildLog() {
  End();
  for (const std::string& complaint : complaints_) std::fprintf(stderr, "%s\n", complaint.c_str());
}

bool ChildLog::Open(const std::string& path) {
  constexpr mode_t kMode = 0666;  // without the umask's
  path_ = path;
  file_ = FileDescriptor(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, kMode));
  return file_.IsOpen();
}

void ChildLog::Append(std::string_view output) {
  if (!file_.IsOpen()) return;
  while (!output.empty()) {
    const ssize_t written = ::write(file_.Get(), output.data(), output.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return NoteMissing(output.size());
    output.remove_prefix(static_cast<std::size_t>(written));
  }
}

void ChildLog::NoteMissing(std::size_t bytes) {
  if (missing_bytes_ == 0) {
    complaints_.push_back(
        fmt::format("{}: cannot be written: {}; it lacks what is said until it can", path_,
                    std::strerror(errno)));
  }
  missing_bytes_ += bytes;
}

void ChildLog::End() {
  file_.Close();
  const std::uint64_t missing = std::exchange(missing_bytes_, 0);
  if (missing > 0) complaints_.push_back(fmt::format("{}: {} bytes are missing", path_, missing));
}

std::vector<std::string> ChildLog::TakeComplaints() { return std::exchange(complaints_, {}); }

}  // namespace giveway::fleetctl

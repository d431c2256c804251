#include "services/fleetctl/doctor/file_lease.h"

#include <fcntl.h>

#include <cerrno>
#include <csignal>

namespace giveway::fleetctl {

FileLease::FileLease(const std::filesystem::path& file)
    : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)) {
  if (!file_.IsOpen()) {
    if (errno == EWOULDBLOCK) outcome_ = Answer::kUsed;  // another has a lease
    return;
  }
  // The kernel signals the holder when another process opens the file; ignored, that would end the
  // process.
  std::signal(SIGIO, SIG_IGN);
  if (::fcntl(file_.Get(), F_SETLEASE, F_WRLCK) == 0) {
    outcome_ = Answer::kAlone;
  } else if (errno == EAGAIN) {
    outcome_ = Answer::kUsed;
  }
}

}  // namespace giveway::fleetctl

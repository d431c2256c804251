#include "tests/support/domain_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>
#include <string>

namespace giveway::test {

DomainLock::DomainLock() {
  const std::string folder = P_tmpdir;  // as fleetctl: one set of locks a machine
  // Different starting points, so that tests that start together rarely try the same file.
  const auto first = static_cast<std::uint32_t>(getpid()) % 99;
  for (std::uint32_t i = 0; i < 99; ++i) {
    domain_ = 1 + (first + i) % 99;
    const std::string path = folder + "/giveway-domain-" + std::to_string(domain_) + ".lock";
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) continue;
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    close(file_);
  }
  throw std::runtime_error("no free DDS domain: every lock file in " + folder + " is taken");
}

DomainLock::~DomainLock() { close(file_); }

}  // namespace giveway::test

#include "services/fleetctl/domain_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace giveway::fleetctl {
namespace {

// Opened for reading, which is enough for flock: so a file another user made can be locked too.
// O_CREAT alone is refused on other users' files in a sticky folder (fs.protected_regular).
FileDescriptor OpenLockFile(const std::string& path) {
  constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NOFOLLOW;
  for (int attempt = 0; attempt < 2; ++attempt) {
    FileDescriptor existing(::open(path.c_str(), kFlags));
    if (existing.IsOpen() || errno != ENOENT) return existing;
    FileDescriptor fresh(::open(path.c_str(), kFlags | O_CREAT | O_EXCL, 0644));
    if (fresh.IsOpen()) {
      ::fchmod(fresh.Get(), 0644);  // whatever the umask says
      return fresh;
    }
    if (errno != EEXIST) return fresh;
  }
  return {};
}

}  // namespace

DomainLock::DomainLock(std::optional<std::uint32_t> wanted) : DomainLock(wanted, P_tmpdir) {}

DomainLock::DomainLock(std::optional<std::uint32_t> wanted, const std::filesystem::path& folder) {
  const std::uint32_t first = wanted.value_or(kFirstDomain);
  const std::uint32_t last = wanted.value_or(kLastDomain);
  std::string trouble;
  for (std::uint32_t domain = first; domain <= last; ++domain) {
    const std::string path =
        (folder / ("giveway-domain-" + std::to_string(domain) + ".lock")).string();
    FileDescriptor lock = OpenLockFile(path);
    if (!lock.IsOpen()) {
      trouble = path + ": " + std::strerror(errno);
      continue;
    }
    if (::flock(lock.Get(), LOCK_EX | LOCK_NB) != 0) continue;
    domain_ = domain;
    lock_ = std::move(lock);
    return;
  }
  if (!trouble.empty()) throw DomainError("cannot lock a domain: " + trouble);
  if (wanted) {
    throw DomainError("domain " + std::to_string(*wanted) +
                      " is taken by another run; wait for it to end, or leave out --domain");
  }
  throw DomainError("all domains from 1 to 99 are taken by other runs; wait for one to end");
}

}  // namespace giveway::fleetctl

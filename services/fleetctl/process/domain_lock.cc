#include "services/fleetctl/process/domain_lock.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
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

// True if no other process has this UDP port on any address.
bool IsPortFree(std::uint32_t port) {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_port = htons(static_cast<std::uint16_t>(port));
  return ::bind(socket.Get(), reinterpret_cast<const sockaddr*>(&any), sizeof any) == 0 ||
         errno != EADDRINUSE;
}

}  // namespace

bool IsSpokenIn(std::uint32_t domain) {
  // RTPS 9.6.2: participant p of domain d receives discovery at 7400 + 250 d + 10 + 2 p. A single
  // process has a low number; the first ten are enough.
  for (std::uint32_t participant = 0; participant < 10; ++participant) {
    if (!IsPortFree(7410 + 250 * domain + 2 * participant)) return true;
  }
  return false;
}

bool IsTaken(std::uint32_t domain) {
  const std::string name = "giveway-domain-" + std::to_string(domain) + ".lock";
  const FileDescriptor lock(
      ::open((std::filesystem::path(P_tmpdir) / name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  return lock.IsOpen() && ::flock(lock.Get(), LOCK_SH | LOCK_NB) != 0;
}

DomainLock::DomainLock(std::optional<std::uint32_t> wanted)
    : DomainLock(wanted, P_tmpdir, IsSpokenIn) {}

DomainLock::DomainLock(std::optional<std::uint32_t> wanted, const std::filesystem::path& folder,
                       bool (*is_spoken_in)(std::uint32_t domain)) {
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
    if (::flock(lock.Get(), LOCK_EX | LOCK_NB) != 0 || is_spoken_in(domain)) continue;
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

// Takes a DDS domain for this run, so that two runs on one machine never hear each other. The lock
// is an flock on a file in the temporary folder that all users share; it is held until the last
// process with the descriptor ends, so children that inherit it keep the domain taken. Fleets that
// do not share that folder (a container on the host's network, another program) are detected by
// their ports.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "services/fleetctl/process/file_descriptor.h"

namespace giveway::fleetctl {

inline constexpr std::uint32_t kFirstDomain = 1;
inline constexpr std::uint32_t kLastDomain = 99;  // above 101 ports collide with ephemeral ones

// No domain could be taken; what() gives the remedy. Main exits with 2.
class DomainError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// True if a participant in this network namespace listens on the domain's ports.
bool IsSpokenIn(std::uint32_t domain);

// True if a run on this machine has the domain.
bool IsTaken(std::uint32_t domain);

class DomainLock {
 public:
  // Takes `wanted`, or the first free domain. Throws DomainError.
  explicit DomainLock(std::optional<std::uint32_t> wanted);
  // The same in another folder and with another check of the ports, for tests.
  DomainLock(std::optional<std::uint32_t> wanted, const std::filesystem::path& folder,
             bool (*is_spoken_in)(std::uint32_t domain));

  std::uint32_t Domain() const { return domain_; }
  int Fd() const { return lock_.Get(); }

 private:
  std::uint32_t domain_ = 0;
  FileDescriptor lock_;
};

}  // namespace giveway::fleetctl

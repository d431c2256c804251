// A DDS domain of 1 to 99 that no other test on this machine uses while the object lives. Lock
// files in the temporary folder; the kernel lets go of them when a process dies.
#pragma once

#include <cstdint>

namespace giveway::test {

class DomainLock {
 public:
  DomainLock();  // Throws std::runtime_error if all are taken.
  ~DomainLock();
  DomainLock(const DomainLock&) = delete;
  DomainLock& operator=(const DomainLock&) = delete;

  std::uint32_t Domain() const { return domain_; }

 private:
  int file_ = -1;
  std::uint32_t domain_ = 0;
};

}  // namespace giveway::test

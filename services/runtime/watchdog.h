// Ends a process whose loop makes no progress: hung in the library, or elsewhere. It writes the
// call stacks of all threads to stderr and exits with kWatchdogExit, for a supervisor to start it
// again: fleetctl run --restart, compose, Kubernetes. Waits of the loop are all shorter than its
// limit.
//
// Time is counted by the watchdog's own wake-ups, so that a process that was stopped, or a machine
// that slept, is no hang.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "services/types/sanitizers.h"
#include "services/types/time.h"

namespace giveway {

inline constexpr int kWatchdogExit = 70;  // EX_SOFTWARE of sysexits.h
// A sanitizer slows a start of many endpoints down tenfold.
#if defined(GIVEWAY_THREAD_SANITIZER) || defined(GIVEWAY_ADDRESS_SANITIZER)
inline constexpr Nanoseconds kWatchdogLimit = std::chrono::seconds(30);
#else
inline constexpr Nanoseconds kWatchdogLimit = std::chrono::seconds(3);
#endif

class Watchdog {
 public:
  explicit Watchdog(Nanoseconds limit = kWatchdogLimit);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  // The loop turns. From the first call on it is watched. Never waits.
  void Feed() { turns_.fetch_add(1, std::memory_order_relaxed); }
  // The loop is over: what follows has limits of its own. Until it turns again.
  void Rest() { turns_.store(0, std::memory_order_relaxed); }

 private:
  void Watch();

  const std::uint64_t limit_;  // wake-ups
  std::atomic<std::uint64_t> turns_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

// Writes the call stacks of all threads of this process to stderr, as addresses that addr2line
// takes. Threads that hold back all signals are named without.
void WriteAllStacks();

}  // namespace giveway

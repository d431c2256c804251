// How long the machine paused: one thread per CPU wakes once a period and records gaps between its
// wake-ups that are too long. A scheduling delay of this thread is one of a vehicle, too. Has
// threads; their findings are queried by time.
#pragma once

#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "services/types/time.h"

namespace giveway::fleetctl {

class StallMonitor {
 public:
  // A thread that wakes every millisecond takes some 1.5 % of a core.
  explicit StallMonitor(Nanoseconds period = std::chrono::milliseconds(1));
  ~StallMonitor() = default;
  StallMonitor(const StallMonitor&) = delete;
  StallMonitor& operator=(const StallMonitor&) = delete;

  // The longest gap between two wake-ups that lies at least in part within [from, to]: never less
  // than the period of the monitor, which is its resolution. Gaps older than ten minutes are
  // dropped.
  Nanoseconds LongestPause(SteadyTime from, SteadyTime to) const;

 private:
  struct Gap {
    SteadyTime from{0};
    SteadyTime to{0};
  };

  void Watch(const std::stop_token& stop, int cpu);
  void Note(const Gap& gap);

  Nanoseconds period_;
  mutable std::mutex mutex_;
  std::deque<Gap> gaps_;  // guarded by mutex_; by their ends
  std::vector<std::jthread> threads_;
};

}  // namespace giveway::fleetctl

#include "services/fleetctl/stopwatch/stall_monitor.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>

#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

// Overhead of a timer and a waking thread: gaps longer than a period by less are not kept.
constexpr Nanoseconds kLate = std::chrono::microseconds(200);
constexpr Nanoseconds kForgotten = std::chrono::minutes(10);

// A pause of one CPU is not visible on another.
void StayOn(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
}

}  // namespace

StallMonitor::StallMonitor(Nanoseconds period) : period_(period) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0) CPU_SET(0, &allowed);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(static_cast<std::size_t>(cpu), &allowed)) continue;
    threads_.emplace_back([this, cpu](const std::stop_token& stop) { Watch(stop, cpu); });
  }
}

void StallMonitor::Watch(const std::stop_token& stop, int cpu) {
  StayOn(cpu);
  SteadyTime before = SteadyNow();
  while (!stop.stop_requested()) {
    SleepUntil(before + period_);
    const SteadyTime now = SteadyNow();
    if (now - before > period_ + kLate) Note({before, now});
    before = now;
  }
}

void StallMonitor::Note(const Gap& gap) {
  const std::scoped_lock lock(mutex_);
  gaps_.push_back(gap);
  while (gaps_.front().to < gap.to - kForgotten) gaps_.pop_front();
}

Nanoseconds StallMonitor::LongestPause(SteadyTime from, SteadyTime to) const {
  const std::scoped_lock lock(mutex_);
  Nanoseconds longest = period_ + kLate;
  // Gaps of several threads are a little out of order: start early enough.
  const auto by_end = [](const Gap& gap, SteadyTime time) { return gap.to < time; };
  auto gap = std::lower_bound(gaps_.begin(), gaps_.end(), from - std::chrono::seconds(1), by_end);
  for (; gap != gaps_.end(); ++gap) {
    if (gap->from < to && gap->to > from) longest = std::max(longest, gap->to - gap->from);
  }
  return longest;
}

}  // namespace giveway::fleetctl

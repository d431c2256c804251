#include "services/fleetctl/virtual/virtual_workers.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace giveway::fleetctl {
namespace {

constexpr std::chrono::milliseconds kProgressPeriod(100);

struct Workers {
  std::mutex mutex;
  std::condition_variable changed;
  std::uint32_t working = 0;
  std::exception_ptr failure;
  std::atomic<std::uint64_t> next = 0;
  std::atomic<bool> stop = false;
};

void WorkUntilDone(std::uint64_t count, const std::function<void(std::uint64_t)>& work,
                   Workers* workers) {
  try {
    for (;;) {
      const std::uint64_t piece = workers->next.fetch_add(1);
      if (piece >= count || workers->stop) break;
      work(piece);
    }
  } catch (...) {
    const std::lock_guard lock(workers->mutex);
    workers->failure = std::current_exception();
    workers->stop = true;
  }
  const std::lock_guard lock(workers->mutex);
  --workers->working;
  workers->changed.notify_one();
}

}  // namespace

void RunOnThreads(std::uint64_t count, std::uint32_t jobs,
                  const std::function<void(std::uint64_t)>& work,
                  const std::function<bool()>& progress) {
  Workers workers;
  workers.working = jobs;
  std::vector<std::jthread> threads;
  for (std::uint32_t i = 0; i < jobs; ++i) {
    threads.emplace_back([&] { WorkUntilDone(count, work, &workers); });
  }
  bool ended = false;
  while (!ended) {
    {
      std::unique_lock lock(workers.mutex);
      ended = workers.changed.wait_for(lock, kProgressPeriod, [&] { return workers.working == 0; });
    }
    if (!progress()) workers.stop = true;
  }
  threads.clear();
  if (workers.failure) std::rethrow_exception(workers.failure);
}

}  // namespace giveway::fleetctl

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

// Starts up to `jobs` threads. With fewer the work takes longer, which is no reason to give it up.
// Throws if not even one can be started.
void StartWorkers(std::uint32_t jobs, const std::function<void()>& run, Workers* workers,
                  std::vector<std::jthread>* threads) {
  threads->reserve(jobs);
  workers->working = jobs;
  try {
    while (threads->size() < jobs) threads->emplace_back(run);
  } catch (const std::exception&) {  // no thread, or no memory for it
    if (threads->empty()) throw;
    const std::lock_guard lock(workers->mutex);
    workers->working -= jobs - static_cast<std::uint32_t>(threads->size());
  }
}

}  // namespace

void RunOnThreads(std::uint64_t count, std::uint32_t jobs,
                  const std::function<void(std::uint64_t)>& work,
                  const std::function<bool()>& progress) {
  Workers workers;
  std::vector<std::jthread> threads;
  StartWorkers(
      jobs, [&] { WorkUntilDone(count, work, &workers); }, &workers, &threads);
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

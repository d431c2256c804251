#include "services/fleetctl/virtual/virtual_batch.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace giveway::fleetctl {
namespace {

constexpr std::chrono::milliseconds kProgressPeriod(100);

// The seeds are handed out one by one; totals are added up under the lock.
struct Shared {
  std::mutex mutex;
  std::condition_variable changed;
  BatchTotals totals;
  std::uint32_t working = 0;
  std::exception_ptr failure;
  std::atomic<std::uint64_t> next;
  std::atomic<bool> stop = false;
};

void Work(const CaseMaker& maker, std::uint64_t last, Shared* shared) {
  for (;;) {
    const std::uint64_t seed = shared->next.fetch_add(1);
    if (seed > last || shared->stop) return;
    const VirtualCase made = maker.Make(static_cast<std::uint32_t>(seed));
    const sim::VirtualOutcome outcome = sim::RunVirtually(made.scenario, made.plan);
    const std::lock_guard lock(shared->mutex);
    shared->totals.Add(static_cast<std::uint32_t>(seed), outcome, maker.HasExpectations());
  }
}

void WorkAndReport(const CaseMaker& maker, std::uint64_t last, Shared* shared) {
  try {
    Work(maker, last, shared);
  } catch (...) {
    const std::lock_guard lock(shared->mutex);
    shared->failure = std::current_exception();
    shared->stop = true;
  }
  const std::lock_guard lock(shared->mutex);
  --shared->working;
  shared->changed.notify_one();
}

// A sum over the seeds is the same in any order.
std::uint64_t OfOneRun(std::uint32_t seed, std::uint64_t hash) { return Random(hash, seed).Next(); }

}  // namespace

void BatchTotals::Add(std::uint32_t seed, const sim::VirtualOutcome& outcome,
                      bool judge_expectations) {
  ++runs;
  contacts += outcome.contacts;
  for (std::size_t i = 0; i < sim::kInvariantCount; ++i) violations[i] += outcome.violations[i];
  const bool missed = judge_expectations && !outcome.unmet.empty();
  if (missed && (unmet == 0 || seed < first_unmet_seed)) {
    first_unmet_seed = seed;
    first_unmet = outcome.unmet;
  }
  if (missed) ++unmet;
  vehicle_seconds += outcome.vehicle_seconds;
  delays_s.insert(delays_s.end(), outcome.delays_s.begin(), outcome.delays_s.end());
  if (outcome.separation_m && (!separation_m || *outcome.separation_m < *separation_m)) {
    separation_m = outcome.separation_m;
  }
  trust += outcome.trust;
  hash += OfOneRun(seed, outcome.hash);
  if (missed || !outcome.held) failing_seeds.push_back(seed);
}

BatchTotals RunBatch(const CaseMaker& maker, const WholeRange& seeds, std::uint32_t jobs,
                     const BatchProgress& progress) {
  Shared shared;
  shared.next = seeds.low;
  shared.working = jobs;
  std::vector<std::jthread> workers;
  for (std::uint32_t i = 0; i < jobs; ++i) {
    workers.emplace_back([&] { WorkAndReport(maker, seeds.high, &shared); });
  }
  {
    std::unique_lock lock(shared.mutex);
    while (shared.working > 0) {
      shared.changed.wait_for(lock, kProgressPeriod, [&] { return shared.working == 0; });
      if (!progress(shared.totals)) shared.stop = true;
    }
  }
  workers.clear();
  if (shared.failure) std::rethrow_exception(shared.failure);
  std::ranges::sort(shared.totals.failing_seeds);
  std::ranges::sort(shared.totals.delays_s);
  return std::move(shared.totals);
}

}  // namespace giveway::fleetctl

#include "services/fleetctl/virtual/virtual_batch.h"

#include <algorithm>
#include <mutex>

#include "services/fleetctl/virtual/virtual_workers.h"

namespace giveway::fleetctl {
namespace {

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
  std::mutex mutex;
  BatchTotals totals;
  const auto run = [&](std::uint64_t piece) {
    const auto seed = static_cast<std::uint32_t>(seeds.low + piece);
    const VirtualCase made = maker.Make(seed);
    const sim::VirtualOutcome outcome = sim::RunVirtually(made.scenario, made.plan);
    const std::lock_guard lock(mutex);
    totals.Add(seed, outcome, maker.HasExpectations());
  };
  RunOnThreads(seeds.high - seeds.low + 1ULL, jobs, run, [&] {
    const std::lock_guard lock(mutex);
    return progress(totals);
  });
  std::ranges::sort(totals.failing_seeds);
  std::ranges::sort(totals.delays_s);
  return totals;
}

}  // namespace giveway::fleetctl

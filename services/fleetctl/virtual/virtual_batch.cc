#include "services/fleetctl/virtual/virtual_batch.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>

#include "services/fleetctl/virtual/virtual_workers.h"

namespace giveway::fleetctl {
namespace {

// A sum over the seeds is the same in any order.
std::uint64_t OfOneRun(std::uint32_t seed, std::uint64_t hash) { return Random(hash, seed).Next(); }

// Of each invariant, in its first seeds: one contact in ten thousand runs is among them.
constexpr std::size_t kShownOfEach = 20;

std::size_t NumberOf(const SeedViolation& violation) {
  std::size_t number = 0;
  while (violation.what.invariant != sim::Name(static_cast<sim::Invariant>(number))) ++number;
  return number;
}

// Contacts first. The selection must not depend on which thread was first.
void KeepFirst(std::vector<SeedViolation>* violations) {
  std::ranges::sort(*violations, {}, [](const SeedViolation& violation) {
    return std::pair(NumberOf(violation), violation.seed);
  });
  std::array<std::size_t, sim::kInvariantCount> count{};
  std::erase_if(*violations, [&count](const SeedViolation& violation) {
    return ++count[NumberOf(violation)] > kShownOfEach;
  });
}

// Each kind once.
std::vector<SeedViolation> FirstOf(std::uint32_t seed, const sim::VirtualOutcome& outcome) {
  std::vector<SeedViolation> first;
  for (const auto* violations : {&outcome.first, &outcome.noted}) {
    for (const sim::Violation& violation : *violations) {
      const std::string name(sim::Name(violation.invariant));
      const bool reported = std::ranges::any_of(
          first, [&](const SeedViolation& other) { return other.what.invariant == name; });
      if (reported) continue;
      first.push_back({seed,
                       Number(violation.tick) * outcome.tick_s,
                       {name, violation.tick, violation.vehicle, violation.other},
                       std::string(Name(violation.rule))});
    }
  }
  return first;
}

struct RunStopped {};

}  // namespace

std::optional<sim::VirtualOutcome> RunUnlessStopped(const VirtualCase& made,
                                                    const std::atomic<bool>& stop) {
  const auto watch = [&stop](const sim::VirtualFleet&) {
    if (stop) throw RunStopped{};
  };
  try {
    return sim::RunVirtually(made.scenario, made.plan, watch);
  } catch (const RunStopped&) {
    return std::nullopt;
  }
}

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
  for (SeedViolation& first : FirstOf(seed, outcome)) first_violations.push_back(std::move(first));
  if (first_violations.size() > 2 * sim::kInvariantCount * kShownOfEach) {
    KeepFirst(&first_violations);
  }
  vehicles += outcome.vehicles;
  arrived += outcome.arrived;
  vehicle_seconds += outcome.vehicle_seconds;
  delays_s.insert(delays_s.end(), outcome.delays_s.begin(), outcome.delays_s.end());
  if (outcome.separation_m && (!separation_m || *outcome.separation_m < *separation_m)) {
    separation_m = outcome.separation_m;
  }
  traffic += outcome.traffic;
  trust += outcome.trust;
  hash += OfOneRun(seed, outcome.hash);
  if (missed || !outcome.held) failing_seeds.push_back(seed);
}

BatchTotals RunBatch(const CaseMaker& maker, const WholeRange& seeds, std::uint32_t jobs,
                     const BatchProgress& progress) {
  std::mutex mutex;
  BatchTotals totals;
  std::atomic<bool> stop = false;
  const auto run = [&](std::uint64_t piece) {
    const auto seed = static_cast<std::uint32_t>(seeds.low + piece);
    const VirtualCase made = maker.Make(seed);
    const std::optional<sim::VirtualOutcome> outcome = RunUnlessStopped(made, stop);
    if (!outcome) return;
    const std::lock_guard lock(mutex);
    totals.Add(seed, *outcome, maker.HasExpectations());
  };
  RunOnThreads(seeds.high - seeds.low + 1ULL, jobs, run, [&] {
    const std::lock_guard lock(mutex);
    stop = !progress(totals);
    return !stop;
  });
  KeepFirst(&totals.first_violations);
  std::ranges::sort(totals.failing_seeds);
  std::ranges::sort(totals.delays_s);
  return totals;
}

}  // namespace giveway::fleetctl

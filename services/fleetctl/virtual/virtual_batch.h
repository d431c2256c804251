// Many virtual runs in parallel, one thread per run, and their combined result, which does not
// depend on the number of threads.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/virtual/virtual_case.h"
#include "services/report/report.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {

struct BatchTotals {
  std::uint32_t runs = 0;
  std::uint32_t contacts = 0;
  std::array<std::uint32_t, sim::kInvariantCount> violations{};
  std::uint32_t unmet = 0;  // runs that missed what their scenario expects
  // What the first of them missed.
  std::uint32_t first_unmet_seed = 0;
  std::string first_unmet;
  double vehicle_seconds = 0;
  std::vector<double> delays_s;
  std::optional<double> separation_m;
  sim::TrafficFigures traffic;
  TrustCounters trust;
  std::uint64_t hash = 0;
  // The first violation of each invariant for each seed, by invariant and seed; of the first seeds,
  // as many as a report shows.
  std::vector<SeedViolation> first_violations;
  std::uint32_t vehicles = 0;
  std::uint32_t arrived = 0;
  std::vector<std::uint32_t> failing_seeds;  // ascending once the batch is over

  void Add(std::uint32_t seed, const sim::VirtualOutcome& outcome, bool judge_expectations);
};

// Called from time to time from the thread that started the batch. False: stop soon.
using BatchProgress = std::function<bool(const BatchTotals& so_far)>;

// The outcome of one run; nullopt if it was stopped before its end, by another thread: at the next
// tick, for a run of a large fleet takes many seconds.
std::optional<sim::VirtualOutcome> RunUnlessStopped(const VirtualCase& made,
                                                    const std::atomic<bool>& stop);

// Runs that were stopped are not in the totals.
BatchTotals RunBatch(const CaseMaker& maker, const WholeRange& seeds, std::uint32_t jobs,
                     const BatchProgress& progress);

}  // namespace giveway::fleetctl

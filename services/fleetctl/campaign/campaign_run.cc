#include "services/fleetctl/campaign/campaign_run.h"

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "services/config/problem.h"
#include "services/fleetctl/campaign/campaign_identity.h"
#include "services/fleetctl/process/program_id.h"
#include "services/fleetctl/virtual/virtual_workers.h"

namespace giveway::fleetctl {
namespace {

CaseOptions OptionsOf(const CampaignPlan& plan, const std::string& generator) {
  CaseOptions options;
  options.scenario = generator;
  if (plan.vehicles) options.vehicles = WholeRange{plan.vehicles->low, plan.vehicles->high};
  options.duration_s = plan.duration_s;
  options.loss_percent = {plan.loss_percent.low, plan.loss_percent.high};
  options.burst = plan.burst;
  options.delay_ms = plan.delay_ms;
  options.jitter_ms = plan.jitter_ms;
  options.reorder_percent = plan.reorder_percent;
  options.duplicate_percent = plan.duplicate_percent;
  options.loops_back = plan.loops_back;
  options.crashes = {plan.crashes, plan.crashes};
  options.pauses = {plan.pauses, plan.pauses};
  options.restarts = {plan.restarts, plan.restarts};
  options.fault_file = plan.fault_file;
  options.skip_unsupported = plan.skip_unsupported;
  return options;
}

// nullopt if it was stopped.
std::optional<BatchTotals> RunOne(const CaseMaker& maker, std::uint32_t seed,
                                  const std::atomic<bool>& stop) {
  const std::optional<sim::VirtualOutcome> outcome = RunUnlessStopped(maker.Make(seed), stop);
  if (!outcome) return std::nullopt;
  BatchTotals totals;
  totals.Add(seed, *outcome, maker.HasExpectations());
  return totals;
}

// Each flag of `fleetctl virtual` is a field here.
CaseMaker MakerOf(const CampaignPlan& plan, const std::string& generator) {
  try {
    return CaseMaker(OptionsOf(plan, generator));
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.Problems();
    for (Problem& problem : problems) {
      if (problem.field == "--vehicles") problem.field = "vehicles";
      if (problem.remedy == "leave the flag out") problem.remedy = "leave them out";
      if (problem.remedy.find("--skip-unsupported") == std::string::npos) continue;
      problem.remedy = "leave it out, or write skip_unsupported: true in the campaign";
    }
    throw InputError(std::move(problems));
  }
}

}  // namespace

CampaignMaker::CampaignMaker(const CampaignPlan& plan) : plan_(plan) {
  for (const std::string& generator : plan.generators) {
    makers_.push_back(MakerOf(plan, generator));
  }
  if (!makers_.empty()) remark_ = makers_.front().Remark();  // of the fault file: all say the same
}

std::optional<ShardResult> RunShard(const CampaignMaker& maker, const ShardOf& shard,
                                    std::uint32_t jobs, const CampaignProgress& progress) {
  const CampaignPlan& plan = maker.Plan();
  const ShardRuns runs(plan, shard);
  ShardResult result{.campaign = plan.name,
                     .plan = PlanHash(plan),
                     .program = ProgramId(),
                     .shard = shard,
                     .planned_runs = plan.Runs(),
                     .flags = FlagsOf(plan),
                     .generators = {}};
  for (const std::string& generator : plan.generators) {
    result.generators.emplace_back().generator = generator;
  }
  std::mutex mutex;
  std::uint32_t done = 0;
  std::atomic<bool> stop = false;
  const auto work = [&](std::uint64_t place) {
    const CampaignRun run = runs.At(static_cast<std::uint32_t>(place));
    const auto totals = RunOne(maker.Of(run.generator), run.seed, stop);
    if (!totals) return;
    const std::lock_guard lock(mutex);
    result.generators[run.generator].Add(*totals);
    ++done;
  };
  RunOnThreads(runs.Count(), jobs, work, [&] {
    const std::lock_guard lock(mutex);
    const bool proceeds = progress(done, runs.Count());
    if (!proceeds) stop = true;
    return proceeds;
  });
  if (done < runs.Count()) return std::nullopt;
  return result;
}

}  // namespace giveway::fleetctl

// Campaigns and results of shards for the tests, without a run.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/campaign/campaign_identity.h"
#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

inline CampaignPlan SmallCampaign() {
  CampaignPlan plan;
  plan.name = "small";
  plan.generators = {"crossing", "swarm", "convoy"};
  plan.seeds = {5, 27};
  plan.vehicles = CampaignWholes{2, 8};
  plan.loss_percent = {0, 20};
  return plan;
}

// Invented results of a seed: figures that differ from seed to seed. Every ninth fails.
inline BatchTotals PretendedRun(std::uint32_t seed) {
  BatchTotals totals;
  totals.runs = 1;
  totals.vehicle_seconds = 0.05 * (100 + seed);
  totals.delays_s = {0.1 * seed, 1.0 / (1 + seed), -0.3};
  totals.separation_m = 1.0 / (3 + seed);
  totals.trust.jumps = seed % 4;
  totals.hash = 0x9e3779b97f4a7c15ULL * (seed + 1);
  if (seed % 9 == 0) {
    totals.failing_seeds = {seed};
    totals.violations[0] = 2;
    totals.contacts = 1;
  }
  return totals;
}

inline ShardResult PretendedShard(const CampaignPlan& plan, const ShardOf& shard) {
  ShardResult result{.campaign = plan.name,
                     .plan = PlanHash(plan),
                     .program = "0123456789abcdef",
                     .shard = shard,
                     .planned_runs = plan.Runs(),
                     .flags = FlagsOf(plan),
                     .generators = {}};
  for (const std::string& generator : plan.generators) {
    result.generators.emplace_back().generator = generator;
  }
  const ShardRuns runs(plan, shard);
  // In reverse: the order in which runs end is not guaranteed.
  for (std::uint32_t place = runs.Count(); place-- > 0;) {
    const CampaignRun run = runs.At(place);
    result.generators[run.generator].Add(PretendedRun(run.seed));
  }
  return result;
}

}  // namespace giveway::fleetctl

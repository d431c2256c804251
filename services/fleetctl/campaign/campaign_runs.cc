#include "services/fleetctl/campaign/campaign_runs.h"

#include <algorithm>

namespace giveway::fleetctl {

ShardRuns::ShardRuns(const CampaignPlan& plan, const ShardOf& shard)
    : first_seed_(plan.seeds.low), left_over_(plan.SeedCount() % shard.of), shard_(shard) {
  const std::uint32_t seeds = plan.SeedCount();
  std::uint32_t end = 0;
  for (std::uint32_t generator = 0; generator < plan.generators.size(); ++generator) {
    const std::uint32_t first = FirstOf(generator);
    if (first < seeds) end += (seeds - 1 - first) / shard.of + 1;
    ends_.push_back(end);
  }
}

std::uint32_t ShardRuns::FirstOf(std::uint32_t generator) const {
  // The shards that got one more of the generators before.
  const std::uint64_t ahead = std::uint64_t{generator} * left_over_ % shard_.of;
  return static_cast<std::uint32_t>((shard_.index + shard_.of - ahead) % shard_.of);
}

CampaignRun ShardRuns::At(std::uint32_t place) const {
  const auto end = std::ranges::upper_bound(ends_, place);
  const auto generator = static_cast<std::uint32_t>(end - ends_.begin());
  const std::uint32_t begin = generator == 0 ? 0 : ends_[generator - 1];
  return {generator, first_seed_ + FirstOf(generator) + (place - begin) * shard_.of};
}

}  // namespace giveway::fleetctl

#include "services/fleetctl/campaign/campaign_runs.h"

#include <algorithm>

namespace giveway::fleetctl {

ShardRuns::ShardRuns(const CampaignPlan& plan, const ShardOf& shard)
    : ShardRuns(plan.SeedCount(), plan.generators.size(), shard) {
  first_seed_ = plan.seeds.low;
}

ShardRuns::ShardRuns(std::uint32_t seeds, std::size_t generators, const ShardOf& shard)
    : left_over_(seeds % shard.of), shard_(shard) {
  std::uint32_t end = 0;
  for (std::size_t generator = 0; generator < generators; ++generator) {
    const std::uint32_t first = FirstOf(static_cast<std::uint32_t>(generator));
    if (first < seeds) end += (seeds - 1 - first) / shard.of + 1;
    ends_.push_back(end);
  }
}

std::uint32_t ShardRuns::CountOf(std::size_t generator) const {
  return ends_[generator] - (generator == 0 ? 0 : ends_[generator - 1]);
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

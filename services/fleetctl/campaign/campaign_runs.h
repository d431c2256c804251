// Which runs of a campaign belong to which shard: every run to exactly one, for any number of
// shards. Seeds are dealt to the shards one by one, so that each has as many of every generator and
// of early and late seeds, and all take about the same time. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/config/campaign/campaign_plan.h"

namespace giveway::fleetctl {

// As many as a Job of Kubernetes can count.
inline constexpr std::uint32_t kMostShards = 100'000;

struct ShardOf {
  std::uint32_t index = 0;  // below `of`
  std::uint32_t of = 1;
};

struct CampaignRun {
  std::uint32_t generator = 0;  // place in the plan
  std::uint32_t seed = 0;
};

class ShardRuns {
 public:
  ShardRuns(const CampaignPlan& plan, const ShardOf& shard);
  // The same of generators with so many seeds each, from 0. `shard` must be one that there is.
  ShardRuns(std::uint32_t seeds, std::size_t generators, const ShardOf& shard);

  std::uint32_t Count() const { return ends_.empty() ? 0 : ends_.back(); }
  std::uint32_t CountOf(std::size_t generator) const;
  CampaignRun At(std::uint32_t place) const;  // place: below Count()

 private:
  // The first of a generator's seeds here, counted from the plan's first. Left-over seeds go
  // to the shards after those that got the previous generator's.
  std::uint32_t FirstOf(std::uint32_t generator) const;

  std::uint32_t first_seed_ = 0;
  std::uint32_t left_over_;  // of a generator's seeds, once all shards have equally many
  ShardOf shard_;
  std::vector<std::uint32_t> ends_;  // by generator: how many runs there are up to its last
};

}  // namespace giveway::fleetctl

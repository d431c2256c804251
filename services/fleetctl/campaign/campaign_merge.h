// Merges all shards of a campaign into one result, or reports everything that prevents it: shards
// that are missing or duplicate, results of other plans or programs. Pure.
#pragma once

#include <string>
#include <vector>

#include "services/config/problem.h"
#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

struct NamedShard {
  std::string where;  // the file it comes from
  ShardResult result;
};

struct MergedCampaign {
  CampaignResult result;  // valid only if there was no problem
  std::vector<Problem> problems;
};

// A result that differs from the first is of another campaign.
MergedCampaign MergeShards(const std::vector<NamedShard>& shards);

// "2,5-7,9", as sbatch --array takes them: ascending numbers, at most a thousand pieces.
std::string NumberRanges(const std::vector<std::uint32_t>& ascending);

}  // namespace giveway::fleetctl

// All shards of a campaign made one result, or everything that keeps them from it: a shard that
// lacks or stands twice, results of other plans or programs. Pure.
#pragma once

#include <string>
#include <vector>

#include "services/config/problem.h"
#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

struct NamedShard {
  std::string where;  // the file it stands in
  ShardResult result;
};

struct MergedCampaign {
  CampaignResult result;  // meant for use only if there was no problem
  std::vector<Problem> problems;
};

// What differs from the first is of another campaign.
MergedCampaign MergeShards(const std::vector<NamedShard>& shards);

// "2, 5 to 7, 9": ascending numbers for people, at most some twenty pieces.
std::string NumbersInWords(const std::vector<std::uint32_t>& ascending);

}  // namespace giveway::fleetctl

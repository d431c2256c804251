// The result of a shard as values. idl/campaign.proto documents each field.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/campaign/campaign_runs.h"
#include "services/fleetctl/campaign/campaign_sums.h"

namespace giveway::fleetctl {

struct ShardResult {
  std::string campaign;
  std::string plan;     // PlanHash
  std::string program;  // ProgramId
  ShardOf shard;
  std::uint32_t planned_runs = 0;
  std::string flags;                     // FlagsOf
  std::vector<CampaignSums> generators;  // in the plan's order
};

// All shards together. `generators` is as of a single shard with all runs.
struct CampaignResult {
  std::string campaign;
  std::string plan;
  std::string program;
  std::string flags;
  std::vector<CampaignSums> generators;
};

}  // namespace giveway::fleetctl

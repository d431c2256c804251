// Runs a shard on threads of this process.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

// How many of the shard's runs are done. False: stop soon.
using CampaignProgress = std::function<bool(std::uint32_t done, std::uint32_t of)>;

// Throws InputError for a fault file that asks for what a virtual run cannot do. `remark` gets what
// is left out, a line each.
class CampaignMaker {
 public:
  explicit CampaignMaker(const CampaignPlan& plan);
  const std::string& Remark() const { return remark_; }
  const CampaignPlan& Plan() const { return plan_; }
  const CaseMaker& Of(std::uint32_t generator) const { return makers_[generator]; }

 private:
  CampaignPlan plan_;
  std::vector<CaseMaker> makers_;
  std::string remark_;
};

// nullopt if it was stopped: half a shard has no result. A run that is stopped ends within a tick:
// runs of large fleets take seconds.
std::optional<ShardResult> RunShard(const CampaignMaker& maker, const ShardOf& shard,
                                    std::uint32_t jobs, const CampaignProgress& progress);

}  // namespace giveway::fleetctl

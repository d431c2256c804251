// The verb `fleetctl campaign`: runs a shard of a campaign, and merges the results of all. Starts
// no other process and contacts no other machine: that is up to the engine that runs the shards.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace giveway::fleetctl {

// A shard that was stopped has no verdict and must be run again: the code of a shell for SIGTERM.
inline constexpr int kShardInterrupted = 143;

struct CampaignShardOptions {
  std::string plan;
  std::optional<std::uint32_t> of;     // absent: the plan's
  std::optional<std::uint32_t> index;  // absent: as the engine says
  std::uint32_t jobs = 1;
  std::string out_folder;  // empty: none
};

struct CampaignMergeOptions {
  std::vector<std::string> files;
  bool json = false;
};

// 0 all passed, 1 some run failed, kShardInterrupted. Throw InputError and OutputError.
int RunCampaignShard(const CampaignShardOptions& options);
int RunCampaignMerge(const CampaignMergeOptions& options);

}  // namespace giveway::fleetctl

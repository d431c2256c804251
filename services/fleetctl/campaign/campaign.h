// The verb `fleetctl campaign`: runs a shard of a campaign, and merges the results of all. It
// starts no other process and speaks to no other machine: that is for the engine that runs the
// shards.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace giveway::fleetctl {

// A shard that was asked to stop has no verdict, and is to be run again: as a shell says of
// SIGTERM.
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

// 0 all held, 1 something did not, kShardInterrupted. Throw InputError and OutputError.
int RunCampaignShard(const CampaignShardOptions& options);
int RunCampaignMerge(const CampaignMergeOptions& options);

}  // namespace giveway::fleetctl

// The verb `fleetctl campaign`: runs a shard of a campaign, and merges the results of all. Starts
// no other process and contacts no other machine: that is up to the engine that runs the shards.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace giveway::fleetctl {

// The shard has no result, or it did not arrive where it was asked for, for a reason that may be
// gone the next time: no thread, no memory, a full disk. EX_TEMPFAIL of sysexits.h; an engine that
// gives up a shard by 1 and 2 alone runs it again.
inline constexpr int kShardNotDone = 75;

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

// Throw InputError and OutputError. 0 all passed, 1 some run failed. Of a shard also kShardNotDone,
// and 128 + the signal that stopped it: 1 and 2 would be taken for final.
int RunCampaignShard(const CampaignShardOptions& options);
// kCouldNotRun if the report cannot be printed.
int RunCampaignMerge(const CampaignMergeOptions& options);

}  // namespace giveway::fleetctl

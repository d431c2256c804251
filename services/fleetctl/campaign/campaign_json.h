// A shard's result as one line of JSON, through idl/campaign.proto, and read back.
#pragma once

#include <string>
#include <string_view>

#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

// The same for the same values, byte for byte.
std::string ToJson(const ShardResult& result);

// Either a result or, in words, all that is wrong with the text.
struct ReadShard {
  ShardResult result;
  std::string complaint;  // empty: the result stands
};
ReadShard ShardFromJson(std::string_view json);

}  // namespace giveway::fleetctl

// A shard's result as one line of JSON, through idl/campaign.proto, and read back.
#pragma once

#include <string>
#include <string_view>

#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

// The same values give the same bytes.
std::string ToJson(const ShardResult& result);

// Either a result, or a message with everything that is wrong with the text.
struct ReadShard {
  ShardResult result;
  std::string complaint;  // empty: the result is valid
};
ReadShard ShardFromJson(std::string_view json);

}  // namespace giveway::fleetctl

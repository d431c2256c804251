// What both JSON objects of a campaign share.
#pragma once

#include <google/protobuf/message.h>

#include <string>

#include "campaign.pb.h"
#include "services/fleetctl/campaign/campaign_sums.h"

namespace giveway::fleetctl {

inline constexpr std::uint32_t kCampaignFormat = 1;

// One line, proto field names, defaults printed, absent values left out.
std::string JsonLine(const google::protobuf::Message& message);
void SetBroken(const CampaignSums& sums, schema::Violations* message);

}  // namespace giveway::fleetctl

// What a whole campaign came to, as JSON and for people. Pure.
#pragma once

#include <string>

#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

bool AllHeld(const CampaignResult& result);
// One line, idl/campaign.proto; the same whatever the shards were.
std::string ReportJson(const CampaignResult& result);
// A table, and a line to run each failing run again.
std::string ReportText(const CampaignResult& result);

}  // namespace giveway::fleetctl

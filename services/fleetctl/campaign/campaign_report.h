// The result of a whole campaign, as JSON and as a table. Pure.
#pragma once

#include <string>

#include "services/fleetctl/campaign/campaign_result.h"

namespace giveway::fleetctl {

bool AllHeld(const CampaignResult& result);
// One line, idl/campaign.proto; independent of how the campaign was split.
std::string ReportJson(const CampaignResult& result);
// A table, and a command line that reproduces each failing run.
std::string ReportText(const CampaignResult& result);

}  // namespace giveway::fleetctl

// Loads and validates a campaign file, and the scenario and fault file it names. Protobuf text in,
// values out, or every problem found in all of them.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "services/config/campaign/campaign_plan.h"

namespace giveway {

// Reads `path`: a file, or the name of a shipped one without folder and ending. Scenarios
// and fault files are found as `fleetctl virtual` finds them. Throws InputError.
CampaignPlan LoadCampaign(const std::string& path, std::span<const std::string_view> generators);

}  // namespace giveway

// A parsed campaign file as values. Finds every problem it can; the values are meant for use only
// if there was none. What stands in the fault file: campaign_file.h.
#pragma once

#include <span>
#include <string_view>

#include "services/config/campaign/campaign_plan.h"
#include "services/config/section.h"

namespace giveway {

// `root` is of the message giveway.schema.CampaignPlan. Problems go to `root`. `generators`: those
// there are.
CampaignPlan ReadCampaign(const Section& root, std::span<const std::string_view> generators);

}  // namespace giveway

// What makes two results comparable: the same campaign run by the same program.
#pragma once

#include <string>
#include <string_view>

#include "services/config/campaign/campaign_plan.h"

namespace giveway::fleetctl {

// FNV-1a, as for every other printed hash; 16 hex digits.
std::string HashOf(std::string_view bytes);

// Everything that decides what a run does, a field per line, defaults included, with the text of
// the scenario and the fault file. How the campaign is split and commented is left out: it changes
// no run.
std::string CanonicalText(const CampaignPlan& plan);
// The hash of that text.
std::string PlanHash(const CampaignPlan& plan);

// The flags of `fleetctl virtual GENERATOR --seed S` that reproduce a run of the plan, each after a
// blank.
std::string FlagsOf(const CampaignPlan& plan);

}  // namespace giveway::fleetctl

// What makes two results comparable: the same campaign run by the same program.
#pragma once

#include <string>

#include "services/config/campaign/campaign_plan.h"

namespace giveway::fleetctl {

// Everything that decides what a run does, a field a line, defaults included, and the scenario and
// the fault file as they stand. How the campaign is cut and commented is left out: it changes no
// run.
std::string CanonicalText(const CampaignPlan& plan);
// Of that text, 16 hex digits.
std::string PlanHash(const CampaignPlan& plan);

// The flags of `fleetctl virtual GENERATOR --seed S` that make a run of the plan, each after a
// blank.
std::string FlagsOf(const CampaignPlan& plan);

// As one word of a shell.
std::string ShellWord(const std::string& text);

// The GNU build id of the running program, in hex digits: the linker's hash of all that is in it,
// which stays when it is stripped or copied. Empty if it was linked without.
std::string ProgramId();

}  // namespace giveway::fleetctl

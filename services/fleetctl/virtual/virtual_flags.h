// The flags that define what a seed means; shared by the verbs that run virtual fleets.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "services/fleetctl/virtual/virtual_case.h"

namespace giveway::fleetctl {

void AddCaseFlags(CLI::App* verb, CaseOptions* made_by);

// "LO..HI", or "N" for both; throws CLI::ValidationError in the flag's name.
WholeRange WholesOf(const std::string& flag, const std::string& text, double least, double most);

}  // namespace giveway::fleetctl

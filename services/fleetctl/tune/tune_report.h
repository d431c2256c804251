// A search's result as a table and as one JSON object.
#pragma once

#include <string>

#include "services/fleetctl/tune/tune_result.h"

namespace giveway::fleetctl {

std::string ToText(const TuneResult& result);
std::string ToJson(const TuneResult& result);

// The result of the fresh runs, as text.
std::string VerdictText(const TuneResult& result);
// "deadline 190 ms (offered 100), lease 250 ms, best effort, depth 4"
std::string QosText(const BeaconQos& qos);

}  // namespace giveway::fleetctl

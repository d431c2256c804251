// Reads shard results from files, and from logs that also have other lines. The log of a whole
// campaign may be large: it is read line by line, and only results are kept.
#pragma once

#include <string>
#include <vector>

#include "services/config/problem.h"
#include "services/fleetctl/campaign/campaign_merge.h"

namespace giveway::fleetctl {

// Adds what is in the file: each line that starts with { is a result, or an error that says why it
// cannot be read.
void ReadResults(const std::string& file, std::vector<NamedShard>* shards, ProblemList* problems);

}  // namespace giveway::fleetctl

// A comparison as a table and as JSON.
#pragma once

#include <string>

#include "services/fleetctl/report/report_compare.h"

namespace giveway::fleetctl {

// At most 78 columns wide; what stayed the same is only counted unless `all`.
std::string ToText(const SoakComparison& comparison, bool all);
// One line: {"worse":true,"figures":[{"what":…,"before":…,"after":…,"change":"worse","p":0.001}]}
std::string ToJson(const SoakComparison& comparison);

}  // namespace giveway::fleetctl

// A finding as text and as JSON.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "services/qos/finding.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {

// Three lines: where, with severity and values; the effect; the remedy. `nowhere` is used if a
// finding is not about a file.
std::string ToText(const qos::Finding& finding, const std::string& nowhere = "environment");
Json ToJson(const qos::Finding& finding);
Json ToJson(const qos::Findings& findings);

// "1 file", "2 files"; the second word if `one` takes no s.
std::string Counted(std::size_t count, std::string_view one, std::string_view many = "");
// "1 error, 0 warnings".
std::string Tally(const qos::Findings& findings);
// The fields errors, warnings and findings.
void AddFindings(const qos::Findings& findings, Json* to);

}  // namespace giveway::fleetctl

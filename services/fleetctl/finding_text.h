// A finding for people and as JSON.
#pragma once

#include <string>

#include "services/qos/finding.h"

namespace giveway::fleetctl {

// Text from a file or from the wire, which must not command the terminal it is shown on.
std::string Shown(std::string text);

// Three lines: where, which values and how bad; what comes of it; the remedy. `nowhere` stands
// where a finding is about no file.
std::string ToText(const qos::Finding& finding, const std::string& nowhere = "environment");
// One JSON object.
std::string ToJson(const qos::Finding& finding);

}  // namespace giveway::fleetctl

// A finding as people and programs read it.
#pragma once

#include <string>

#include "services/qos/finding.h"

namespace giveway::fleetctl {

// Three lines: where and what, what comes of it, what to do.
std::string ToText(const qos::Finding& finding);
std::string ToJson(const qos::Finding& finding);

}  // namespace giveway::fleetctl

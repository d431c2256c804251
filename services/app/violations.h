// Broken invariants of a run, and what did not fit, as both reports print them.
#pragma once

#include <vector>

#include "services/app/report.h"

namespace giveway::schema {
class Trust;
class Violations;
}  // namespace giveway::schema

namespace giveway::app {

void SetViolations(const std::vector<BrokenInvariant>& violations, schema::Violations* message);
void SetTrust(const TrustCounters& counters, schema::Trust* message);

}  // namespace giveway::app

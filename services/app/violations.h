// Broken invariants of a run as both reports print them.
#pragma once

#include <vector>

#include "services/app/report.h"

namespace giveway::schema {
class Violations;
}

namespace giveway::app {

void SetViolations(const std::vector<BrokenInvariant>& violations, schema::Violations* message);

}  // namespace giveway::app

// The impairment of a scenario: what is to go wrong with the packets the vehicles hear.
#pragma once

#include <vector>

#include "services/app/plan_read.h"
#include "services/app/section.h"
#include "services/types/impairment.h"

namespace giveway::app {

ImpairmentRule ReadImpairmentRule(const Section& section, const KnownIds& known);

}  // namespace giveway::app

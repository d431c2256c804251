// A scenario in numbers that people read: what a generator draws has seventeen digits.
#pragma once

#include "services/types/scenario.h"

namespace giveway {

// Places, bodies, speeds and rates in thousandths of their units, angles in thousandths of degrees.
Scenario Rounded(Scenario scenario);

}  // namespace giveway

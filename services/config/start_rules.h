// Where bodies stand at the start: clear of each other and of the place, outside their goals.
#pragma once

#include <string>

#include "services/config/scenario_read.h"

namespace giveway {

// Vehicles, spawn places and obstacles clear of each other, of the walls and of the doorways, and
// each vehicle outside its own goal, and able to turn there where it has corners: at most one
// problem a body and kind. Bodies and walls may be as many as a file holds. `cause` starts the
// message, e.g. "with seed 7 ".
void CheckStarts(const ReadScenario& read, const std::string& cause);

// PerturbBySeed, on a scenario whose starts are right as they are. Throws InputError if the seed
// puts one where CheckStarts refuses it; `file` names the scenario.
void PerturbWithinRules(const std::string& file, Scenario* scenario);

}  // namespace giveway

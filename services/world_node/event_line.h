// What the log says of an event of the run.
#pragma once

#include <string>

#include "services/types/fleet_facts.h"

namespace giveway {

// What an operator should read of it; empty for what only observers need.
std::string LogLine(const WorldEvent& event);

}  // namespace giveway

// One virtual run shown: a picture of the ways, and a trace of every vehicle in every tick.
#pragma once

#include <string>

#include "services/fleetctl/virtual/virtual_case.h"

namespace giveway::fleetctl {

// Runs the case and writes what is asked for; an empty name asks for nothing. Throws OutputError.
void ShowRun(const VirtualCase& made, const std::string& picture_file,
             const std::string& trace_file);

}  // namespace giveway::fleetctl

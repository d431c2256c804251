// Where a report comes from: the line that repeats the soak, and which programs on which system
// ran.
#pragma once

#include <filesystem>
#include <string>

#include "services/fleetctl/soak/soak_result.h"
#include "services/fleetctl/soak/verb/soak_options.h"

namespace giveway::fleetctl {

// One line for a shell. Without the domain, which is whichever is free, and the key of orders.
std::string CommandLine(const SoakOptions& options);

// `program_folder` has the services. In virtual time they do not run.
SoakVersions VersionsOf(const std::filesystem::path& program_folder, bool in_virtual_time);

}  // namespace giveway::fleetctl

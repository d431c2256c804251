// What was wrong with a command line, and the verb or flag that was probably meant.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace giveway::fleetctl {

// The verb that was named, as far as it was: "fleetctl qos check".
std::string NamedVerb(const CLI::App& fleetctl);

// One or more lines, without a final line feed. `fleetctl` has parsed the line and refused it.
std::string ExplainUsageError(const CLI::App& fleetctl, const CLI::ParseError& error);

}  // namespace giveway::fleetctl

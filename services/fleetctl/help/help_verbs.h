// The verbs about the command line itself: help, version, completion.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace giveway::fleetctl {

// `version` is the line that is printed.
void AddHelpVerbs(CLI::App* fleetctl, const std::string& version, int* exit_code);

}  // namespace giveway::fleetctl

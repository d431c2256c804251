// The flags of the verbs that listen to a fleet which was started elsewhere.
#pragma once

#include <CLI/CLI.hpp>

#include "services/fleetctl/reading_along.h"

namespace giveway::fleetctl {

void AddObserverFlags(CLI::App* verb, ObserverOptions* options);
// A check for --duration and --wait: CLI11's own lets "nan" pass.
std::string CheckSeconds(const std::string& text);

}  // namespace giveway::fleetctl

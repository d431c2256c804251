// The flags of the verbs that listen to a fleet which was started elsewhere.
#pragma once

#include <CLI/CLI.hpp>

#include "services/fleetctl/args/reading_along.h"

namespace giveway::fleetctl {

void AddObserverFlags(CLI::App* verb, ObserverOptions* options);
// Of the verbs that give orders.
void AddAdminKeyFlag(CLI::App* verb, std::string* file);

}  // namespace giveway::fleetctl

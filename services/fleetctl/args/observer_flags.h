// The flags of verbs that listen to a fleet started elsewhere.
#pragma once

#include <CLI/CLI.hpp>

#include "services/fleetctl/args/observer_session.h"

namespace giveway::fleetctl {

void AddObserverFlags(CLI::App* verb, ObserverOptions* options);
// Of verbs that give orders.
void AddAdminKeyFlag(CLI::App* verb, std::string* file);

}  // namespace giveway::fleetctl

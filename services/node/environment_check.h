// Variables of the environment that a service does not read, or that have another effect than their
// author expects: GIVEWAY_DISCOVERY_SERVERS of --discovery-server.
#pragma once

#include <string>
#include <vector>

namespace giveway {

// A line for each of these, NAME=value; the rules are those of `fleetctl qos check`.
std::vector<std::string> EnvironmentWarnings(const std::vector<std::string>& variables);

// Logs those of this process.
void WarnOfEnvironment();

}  // namespace giveway

// The verb `tune` below `fleetctl qos`.
#pragma once

#include <CLI/CLI.hpp>

namespace giveway::fleetctl {

void AddQosTune(CLI::App* qos, int* exit_code);

}  // namespace giveway::fleetctl

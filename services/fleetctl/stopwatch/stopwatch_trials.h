// Conducts the trials of one fleet: waits until all receive all, injects faults, collects what the
// peers report, heals, and starts again.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "services/fleetctl/stopwatch/stall_monitor.h"
#include "services/fleetctl/stopwatch/stopwatch_figures.h"
#include "services/fleetctl/stopwatch/stopwatch_fleet.h"

namespace giveway::fleetctl {

// The task of one fleet.
struct StopwatchTask {
  Fault fault = Fault::kKill;
  std::uint32_t trials = 0;
  std::uint64_t seed = 0;
  std::vector<VehicleId> fleet;
};

struct StopwatchResult {
  std::vector<Trial> trials;
  // Losses that peers reported of one another, or of a target before its fault: false alarms.
  std::uint32_t false_alarms = 0;
  bool too_soon = false;  // the blackouts started while a vehicle was not well: no trial was made
  std::string problem;    // why it ended early; empty: it did not
};

// Calls `note` after every wave with the number of its trials. Throws StartError, DomainError.
StopwatchResult Conduct(const StopwatchTask& task, const FleetSpec& spec, const Limits& limits,
                        const StallMonitor& monitor, const std::function<void(std::size_t)>& note);

}  // namespace giveway::fleetctl

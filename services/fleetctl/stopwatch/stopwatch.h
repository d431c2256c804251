// The verb `fleetctl stopwatch`: how long until peers notice? Several fleets in parallel, real
// processes, each fault as often as requested. Values in; the exit code out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/stopwatch/stopwatch_table.h"

namespace giveway::fleetctl {

struct StopwatchOptions {
  std::uint32_t vehicles = 8;  // a fleet
  std::uint32_t trials = 20;   // a fault
  std::vector<Fault> faults;   // in the order of the table
  std::uint32_t fleets = 3;    // at a time
  std::string qos_file;        // a file or a shipped set; empty: the default
  std::string interface = "127.0.0.1";
  std::uint32_t seed = 1;
  std::string logs_folder;  // empty: no logs are kept
  bool json = false;        // one JSON object on stdout and nothing else
  bool table = false;       // only print which mechanism must see which fault
};

// 0 every promise was kept; 1 one was broken, or not every trial was made; 2 none could be made.
int RunStopwatch(const StopwatchOptions& options);

}  // namespace giveway::fleetctl

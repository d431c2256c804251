// A fleet started elsewhere as a table, and as a JSON object. Pure: takes what was received, the
// time and the size of the terminal.
#pragma once

#include <string>
#include <vector>

#include "services/fleetctl/output/live_table.h"
#include "services/observer/fleet/fleet_snapshot.h"

namespace giveway::fleetctl {

// Where the observer listens, and since when.
struct ListeningPost {
  std::uint32_t domain = 0;
  std::string interface;
  std::string area;
  SteadyTime since{0};
};

// Fits the terminal as TableLines does.
std::vector<std::string> TopLines(const FleetSnapshot& fleet, const ListeningPost& post,
                                  SteadyTime now, TerminalSize size);
std::string TopJson(const FleetSnapshot& fleet, const ListeningPost& post, SteadyTime now);
// What to check if nothing is received.
std::string NothingHeard(const ListeningPost& post, SteadyTime now);

}  // namespace giveway::fleetctl

// What the operator asked of `fleetctl qos apply`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/args/reading_along.h"

namespace giveway::fleetctl {

struct QosApplyOptions {
  ObserverOptions where;          // its qos_file: what the fleet runs with
  std::string profile;            // path or name of a shipped set: what it shall run with
  std::vector<std::uint32_t> to;  // vehicle ids
  bool all = false;               // instead of `to`: every vehicle and the world
  std::uint32_t canary = 0;       // one of them, or 0: none goes first
  double watch_s = 10;            // how long the canary is on trial
  bool restart = true;            // false: only if every change takes effect while they run
  bool dry_run = false;           // says what would change
  bool force = false;             // though old and new profiles do not match
  bool json = false;
};

}  // namespace giveway::fleetctl

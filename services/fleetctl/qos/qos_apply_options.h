// The operator's options for `fleetctl qos apply`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/args/observer_session.h"

namespace giveway::fleetctl {

struct QosApplyOptions {
  ObserverOptions where;          // its qos_file: the fleet's current set
  std::string profile;            // path or name of a shipped set: the new one
  std::vector<std::uint32_t> to;  // vehicle ids
  bool all = false;               // instead of `to`: every vehicle and the world
  std::uint32_t canary = 0;       // one of them, or 0: no canary
  double watch_s = 10;            // how long the canary is on trial
  bool restart = true;            // false: only if every change takes effect while they run
  bool dry_run = false;           // says what would change
  bool force = false;             // even if old and new profiles do not match
  bool json = false;
};

}  // namespace giveway::fleetctl

// The operator's options for `fleetctl doctor`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/discovery_server.h"

namespace giveway::fleetctl {

struct DoctorOptions {
  std::optional<std::uint32_t> domain;  // its processes alone; without it all, else the first
  std::uint32_t vehicles = 2;           // that will run
  std::string qos;                      // a file, or a shipped set; empty: the default
  std::string interface = "127.0.0.1";
  std::vector<DiscoveryServer> discovery_servers;  // none: as the set says
  bool fix = false;  // remove files in shared memory that no process uses
  bool json = false;
  bool quiet = false;  // the exit code alone
};

}  // namespace giveway::fleetctl

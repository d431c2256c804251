// What the operator asked of `fleetctl run`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/decision.h"
#include "services/types/discovery_server.h"

namespace giveway::fleetctl {

// Absent values are the scenario's.
struct RunOptions {
  std::string scenario;  // a file, or the name of a shipped scenario
  std::optional<double> duration_s;
  std::optional<std::uint32_t> seed;
  std::optional<Behaviour> behaviour;
  // Of an open fleet: how many are started that nobody named. Absent: as many as the scenario waits
  // for, or one a spawn place where it waits for none.
  std::optional<std::uint32_t> vehicles;
  std::optional<std::uint32_t> domain;  // absent: the first free one
  std::string interface = "127.0.0.1";
  std::vector<DiscoveryServer> discovery_servers;  // none: as the QoS file says
  std::string qos_file;                            // empty: the shipped one
  std::string impair;  // of what the vehicles hear, see config/impair.h; empty: the scenario's
  bool lockstep = false;
  std::string log_level = "info";  // of the world and the vehicles
  std::string logs_folder;         // empty: no logs are kept
  std::string record_folder;       // empty: vehicles record nothing
  std::string record_split;        // a size, see config/byte_size.h; empty: a recording is one file
  std::string picture_file;        // empty: none is drawn
  bool json = false;               // one JSON object on stdout and nothing else
};

}  // namespace giveway::fleetctl

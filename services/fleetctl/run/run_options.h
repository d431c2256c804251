// The operator's options for `fleetctl run`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/fleetctl/process/fleet_commands.h"

namespace giveway::fleetctl {

struct RunOptions {
  std::string scenario;                 // a file, or the name of a shipped scenario
  std::optional<std::uint32_t> domain;  // absent: the first free one
  std::string qos_file;                 // empty: the shipped one
  FleetOptions fleet;
  bool restart = false;      // processes that die are started again
  std::string picture_file;  // empty: none is drawn
  std::string html_file;     // empty: no page of the run is written
  std::string topics_file;   // empty: samples are not recorded
  bool json = false;         // one JSON object on stdout and nothing else
};

}  // namespace giveway::fleetctl

// Finds the processes of fleets on this machine and reads their situation, from /proc alone:
// nothing is stopped, entered or written to. Another folder of the same layout can be read instead.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"

namespace giveway::fleetctl {

// What can be read of every process quickly.
struct FleetMember {
  int pid = 0;
  bool is_world = false;
  VehicleId id = kNoVehicle;  // assigned by the world, or requested, or observed
  std::uint32_t domain = 0;
  std::string interface;
  std::optional<std::uint64_t> network_namespace;
};

// Of all processes, ascending.
std::vector<int> ProcessIds(const std::filesystem::path& proc);

// By process id. Includes those of other users, as far as they can be read.
std::vector<FleetMember> FindFleet(const std::filesystem::path& proc);

// The UDP ports that fleetctl and observers hold: of whatever domain, for their flags do not name
// one where they found a fleet. nullopt if those of one of them cannot be read.
std::optional<std::vector<std::uint16_t>> PortsOfTools(const std::filesystem::path& proc);

// Everything that can be read; the rest is named in `not_known`. nullopt if there is no such
// process, or it does not belong to a fleet.
std::optional<ProcessSituation> ReadSituation(const std::filesystem::path& proc, int pid);

}  // namespace giveway::fleetctl

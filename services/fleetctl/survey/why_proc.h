// Finds the processes of fleets on this machine and reads where they stand, from /proc alone:
// nothing is stopped, entered or written to. Another folder of the same shape can be read instead.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"

namespace giveway::fleetctl {

// What is to be seen of every process, at a glance.
struct FleetMember {
  int pid = 0;
  bool is_world = false;
  VehicleId id = kNobody;  // that the world gave, or that it asked for, or was heard to have
  std::uint32_t domain = 0;
  std::string interface;
  std::optional<std::uint64_t> network_namespace;
};

// A whole file; nothing, and errno, if it cannot be opened.
std::optional<std::string> ReadText(const std::filesystem::path& file);

// Of all processes, ascending.
std::vector<int> ProcessIds(const std::filesystem::path& proc);

// By process id. Those of other users count too, as far as they can be seen.
std::vector<FleetMember> FindFleet(const std::filesystem::path& proc);

// Everything that can be read; what cannot is in `not_known`. Nothing if there is no such process,
// or it is none of a fleet's.
std::optional<ProcessSituation> ReadSituation(const std::filesystem::path& proc, int pid);

}  // namespace giveway::fleetctl

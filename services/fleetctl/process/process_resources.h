// The resources a process uses, from /proc; see proc(5).
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string_view>

namespace giveway::fleetctl {

struct ProcessResources {
  double cpu_s = 0;  // user and system, since the process started
  std::uint64_t resident_bytes = 0;
  std::uint64_t private_bytes = 0;  // resident, shared with no other process, in no file
  std::uint32_t threads = 0;
  std::uint32_t descriptors = 0;
};

struct MachineUnits {
  double ticks_per_s = 0;
  std::uint64_t page_bytes = 0;
};

// All but the descriptors, from the text of stat and of statm. nullopt if stat is incomplete.
// Pure.
std::optional<ProcessResources> ParseResources(std::string_view stat, std::string_view statm,
                                               const MachineUnits& units);
// nullopt if the process is gone.
std::optional<ProcessResources> ReadResources(pid_t pid);
// User and system time of this process, in seconds.
double OwnProcessorSeconds();

}  // namespace giveway::fleetctl

// What `fleetctl doctor` examines: the facts of one host, as values. Read by doctor_read.h and
// memory_read.h, judged by doctor_rules.h. Facts that could not be read are absent, or named in
// `not_known`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/doctor/shared_memory.h"
#include "services/fleetctl/survey/why_situation.h"
#include "services/link/fastdds/interfaces.h"

namespace giveway::fleetctl {

// In the doctor's own network namespace.
struct HostInterface : link::Interface {
  std::optional<bool> echoes_multicast;  // what was sent to the group there came back
};

// Where services run, and what the library would read there by itself.
struct Surroundings {
  std::string folder;                     // their working folder
  std::string who;                        // "this shell", "vehicle 2 (pid 123)"
  std::vector<std::string> environment;   // NAME=value
  std::vector<std::string> folder_files;  // names
};

struct ClockFacts {
  std::vector<std::int64_t> offsets_ns;  // wall clock less monotonic clock, one look after another
  std::int64_t window_ns = 0;            // from the first look to the last
  std::optional<bool> synchronised;      // as set in the kernel
};

struct PortRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

struct HostFacts {
  ProcessSituation planned;    // a vehicle as it would be started now: set, interface, domain
  std::uint32_t vehicles = 2;  // how many are to run
  std::uint32_t user = 0;      // who examines
  std::vector<std::uint32_t> domains;       // to examine
  std::vector<ProcessSituation> processes;  // of fleets, living
  SharedMemory memory;
  std::vector<HostInterface> interfaces;
  std::optional<std::int64_t> receive_buffer_max;   // bytes, net.core.rmem_max
  std::optional<std::vector<std::uint16_t>> ports;  // UDP ports taken in this network namespace
  std::optional<std::vector<std::uint16_t>> tool_ports;  // of those, fleetctl's and observers'
  std::optional<PortRange> ephemeral;                    // that the system hands out by itself
  std::vector<PortRange> reserved;                       // of those: never handed out
  std::optional<std::uint64_t> open_files_limit;         // of this shell
  std::vector<Surroundings> surroundings;
  ClockFacts clock;
  std::vector<std::string> not_known;  // "pid 12: maps: Permission denied"
};

}  // namespace giveway::fleetctl

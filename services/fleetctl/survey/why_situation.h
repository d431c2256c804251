// The situation of a process of a fleet: its launch options, and its network and memory. Values
// only. What could not be read is absent, and named in `not_known`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/qos/profile_set.h"
#include "services/types/discovery_server.h"
#include "services/types/ids.h"
#include "services/types/impairment.h"

namespace giveway::fleetctl {

struct NetworkAddress {
  std::string interface;      // its name
  std::uint32_t address = 0;  // IPv4, the first number in the highest byte
  std::uint32_t mask = 0;

  friend bool operator==(const NetworkAddress&, const NetworkAddress&) = default;
};

// Two files are the same if both numbers are equal.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;

  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

// Of a service: from its command line, its environment and the scenario they name.
struct LaunchOptions {
  bool is_world = false;
  VehicleId id = kNoVehicle;  // of a vehicle that requested one
  std::uint32_t domain = 0;
  std::string interface = "127.0.0.1";
  // Overrides the profile set's discovery; none: as the set says.
  std::vector<DiscoveryServer> discovery_servers;
  std::string qos_file;  // as the process sees it; absolute
  std::string scenario;
  bool partition_free = false;
  bool leaves_out_shared_memory = false;  // that transport of its set
  // Of the scenario.
  std::string area = "main";
  std::uint32_t fleet_size = 2;
  bool radar = false;  // of this vehicle, here and below
  bool lidar = false;
  bool camera = false;
  bool pose_fix = false;
  bool signals = false;
  Impairment impairment;  // of what it receives
};

struct ProcessSituation {
  int pid = 0;
  std::string participant;  // the first twelve bytes of its GUIDs, hexadecimal; empty: not known
  int pid_inside = 0;       // in its own namespace of process ids, as in its GUID; 0: not known
  LaunchOptions launch;
  std::optional<qos::ProfileSet> profiles;  // the set as the file is now
  bool profiles_changed = false;            // the file was written to after the process started

  std::optional<char> state;  // as in /proc: R, S, D, T, t, Z
  std::optional<std::uint64_t> network_namespace;
  std::optional<std::uint64_t> ipc_namespace;
  std::optional<std::uint64_t> mount_namespace;
  std::optional<FileIdentity> shared_memory;  // its /dev/shm
  std::optional<std::vector<NetworkAddress>> addresses;
  std::optional<std::vector<std::uint16_t>> ports;  // UDP ports it holds
  std::optional<std::uint64_t> open_files;
  std::optional<std::uint64_t> open_files_limit;
  std::vector<std::string> environment;  // NAME=value, its whole environment at start
  std::vector<std::string> not_known;    // "network namespace: Permission denied"
};

// "vehicle 2 (pid 123)", "the world (pid 124)".
std::string NameOf(const ProcessSituation& process);
std::string AddressText(std::uint32_t address);

// Those of its addresses that its whitelist allows.
std::vector<NetworkAddress> AllowedAddresses(const ProcessSituation& process);
// Fast DDS 2.9.1: 16 bits of the MD5 of every address but the loopback's. Absent if the addresses
// are not known.
std::optional<std::uint16_t> HostId(const ProcessSituation& process);
// A policy of its participant profile; absent if the set or the profile is not known.
std::optional<std::int64_t> ParticipantNumber(const ProcessSituation& process, qos::Policy policy);
// How it finds others, see qos::Discovery: as its options say, else its set. Absent if neither is
// known.
std::optional<std::int64_t> DiscoveryProtocol(const ProcessSituation& process);
bool UsesSharedMemory(const ProcessSituation& process);
// The ids of the participants whose ports it holds.
std::vector<std::uint32_t> ParticipantIds(const ProcessSituation& process);

}  // namespace giveway::fleetctl

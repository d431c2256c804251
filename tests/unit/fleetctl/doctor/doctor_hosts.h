// A healthy host on which two vehicles may run, to be corrupted one fact at a time.
#pragma once

#include <string>

#include "services/fleetctl/doctor/doctor_facts.h"
#include "tests/unit/fleetctl/why/why_situations.h"

namespace giveway::fleetctl {

inline MemoryFile FileNamed(const std::string& name) {
  MemoryFile file;
  file.name = name;
  file.bytes = 1000;
  file.user = 1000;
  file.mode = name.ends_with("_el") ? 0666 : 0644;
  file.age_s = 60;
  return file;
}

// A segment and its lock, held by a live process.
inline void AddSegment(const std::string& name, SharedMemory* memory) {
  memory->files.push_back(FileNamed(name));
  memory->files.back().users = {101};
  memory->files.push_back(FileNamed(name + "_el"));
  memory->files.back().locked = true;
}

// The same after its owner was killed.
inline void AddStaleSegment(const std::string& name, SharedMemory* memory) {
  memory->files.push_back(FileNamed(name));
  memory->files.push_back(FileNamed(name + "_el"));
}

inline HostFacts HealthyHost() {
  HostFacts host;
  host.planned.profiles = SetWith("", "", "", true);
  host.user = 1000;
  host.domains = {7};
  host.processes = {Vehicle(1), Vehicle(2)};
  for (ProcessSituation& process : host.processes) {
    process.profiles = SetWith("", "", "", true);
    process.ipc_namespace = 4026531842;
  }
  host.memory.folder = "/dev/shm";
  host.memory.total_bytes = 64'000'000;
  host.memory.free_bytes = 60'000'000;
  AddSegment("fastrtps_0123456789abcdef", &host.memory);
  HostInterface loopback;
  loopback.name = "lo";
  loopback.address = "127.0.0.1";
  loopback.loopback = true;
  loopback.says_multicast = false;
  loopback.echoes_multicast = true;
  host.interfaces = {loopback};
  host.receive_buffer_max = 4'194'304;
  host.ports = {{9150, 9162, 9163, 9164, 9165}};  // those of the two, and of the group
  host.tool_ports.emplace();
  host.ephemeral = PortRange{32768, 60999};
  host.open_files_limit = 1024;
  host.surroundings = {{"/home/me", "this shell", {"HOME=/home/me"}, {"notes.txt"}}};
  host.clock = {{5, 100'005, 10}, 200'000'000, true};
  return host;
}

}  // namespace giveway::fleetctl

// The operator's options for `fleetctl soak`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace giveway::fleetctl {

struct SoakOptions {
  std::string scenario;     // a file, or the name of a shipped scenario
  std::string faults;       // a file, or the name of a shipped one; empty: see soak_faults.h
  double duration_s = 300;  // from the start signal to the verdict
  std::uint32_t seed = 1;   // of scenario and faults
  std::string report_folder;
  std::optional<std::uint32_t> vehicles;  // of an open fleet; absent: one a place
  std::optional<std::uint32_t> domain;    // absent: the first free one
  std::string qos_file;                   // empty: the shipped one
  std::string interface = "127.0.0.1";
  std::string admin_key;                // a file; empty: one is created for the soak
  std::uint32_t discovery_servers = 0;  // that the soak starts; its fleet finds itself through them
  std::string attacker;                 // the program of the intruder; empty: none
  bool skip_unsupported = false;  // leave out what this host cannot do, and say so in the report
  bool record = false;            // every vehicle records into the report folder
  std::uint32_t ring_s = 0;       // length of each ring; 0: everything, if `record` is set
  bool in_virtual_time = false;   // no processes: see soak_virtual.h
  std::string resume;             // continues in this report folder; empty: starts a new one
  std::string around;             // runs nothing: a folder, see soak_around.h; empty: not requested
  bool json = false;              // the report as one JSON object on stdout and nothing else
};

}  // namespace giveway::fleetctl

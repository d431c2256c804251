// The verb `fleetctl qos show`: the QoS every endpoint would run with, and the origin of each
// value; or the differences between two files. Values in; the exit code out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace giveway::fleetctl {

struct QosShowOptions {
  std::string qos_file;             // path or name of a shipped set; empty: the shipped default
  std::vector<std::string> diff;    // two of these instead; or empty
  std::vector<std::string> wanted;  // profiles or topics; empty: all
  std::string interface = "127.0.0.1";
  std::uint32_t vehicles = 2;
  bool json = false;
};

// 0 shown, 1 the two files differ, 2 could not run.
int RunQosShow(const QosShowOptions& options);

}  // namespace giveway::fleetctl

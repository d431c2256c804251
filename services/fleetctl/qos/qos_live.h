// `fleetctl qos show --live`: the QoS a running vehicle reports for its beacons, compared with what
// a profile file would give it. Values in, exit code out.
#pragma once

#include <cstdint>
#include <string>

#include "services/fleetctl/qos/qos_show.h"

namespace giveway::fleetctl {

struct QosLiveOptions {
  QosShowOptions set;        // the file to compare with
  bool of_its_fleet = true;  // the fleet's size is as the vehicle says, not `set.vehicles`
  std::uint32_t vehicle = 0;
  std::uint32_t domain = 0;
  std::string admin_key;  // a file; empty: that of a fleet started here, if there is one
};

// 0 as in the file, 1 otherwise, 2 not received or could not run.
int RunQosLive(const QosLiveOptions& options);

}  // namespace giveway::fleetctl

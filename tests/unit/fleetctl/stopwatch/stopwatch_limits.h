// What a fleet with config/qos/default.xml promises.
#pragma once

#include <chrono>

#include "services/fleetctl/stopwatch/stopwatch_table.h"

namespace giveway::fleetctl {

inline Limits Shipped() {
  using std::chrono::milliseconds;
  return {.beacon_period = milliseconds(50),
          .beacon_age = milliseconds(200),
          .deadline = milliseconds(150),
          .liveliness = milliseconds(250),
          .lease = std::chrono::seconds(10)};
}

}  // namespace giveway::fleetctl

// Observes a fleet for a time span and collects the counts of one vehicle and of the rest.
#pragma once

#include <chrono>
#include <map>
#include <string>

#include "services/fleetctl/qos/canary.h"
#include "services/link/observer_link.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class CanaryWatch {
 public:
  explicit CanaryWatch(const link::LinkOptions& options) : observer_(options) {}

  // Waits until the vehicle has taken a beacon since its process started; false after `patience`.
  bool WaitUntilItHears(VehicleId vehicle, std::chrono::milliseconds patience);
  struct Both {
    ServiceFigures canary;
    ServiceFigures rest;
    std::string trouble;  // what happened to the canary meanwhile; empty: nothing
  };
  Both Watch(VehicleId vehicle, Nanoseconds span);

 private:
  struct Seen {
    VehicleStatus first;
    SteadyTime first_at{0};
    VehicleStatus last;
    SteadyTime last_at{0};
    bool restarted = false;  // its process
  };
  void Take();

  link::ObserverLink observer_;
  std::map<VehicleId, Seen> seen_;
};

}  // namespace giveway::fleetctl

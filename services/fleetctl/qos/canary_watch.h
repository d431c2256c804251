// Observes a fleet for a time span and collects the counts of one vehicle and of the rest.
#pragma once

#include <chrono>
#include <string>

#include "services/fleetctl/qos/canary.h"
#include "services/link/observer_link.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class CanaryWatch {
 public:
  explicit CanaryWatch(const link::LinkOptions& options) : observer_(options) {}

  // Before an order: what comes behind it may be of the process that it restarts.
  void WaitUntilSeen(VehicleId vehicle, std::chrono::milliseconds patience);
  // Waits until the vehicle has taken a beacon since its process started, where the order restarts
  // it since then; false after `patience`.
  bool WaitUntilItHears(VehicleId vehicle, bool restarts, std::chrono::milliseconds patience);
  struct Both {
    ServiceFigures canary;
    ServiceFigures rest;
    std::string trouble;  // what happened to the canary meanwhile; empty: nothing
  };
  Both Watch(VehicleId vehicle, Nanoseconds span);

 private:
  void Take();

  link::ObserverLink observer_;
  SeenVehicles seen_;
};

}  // namespace giveway::fleetctl

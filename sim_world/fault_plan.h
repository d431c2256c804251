// Says when a scenario's planned faults are due. Whoever runs the vehicles makes them happen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/body.h"
#include "sim_world/event_log.h"

namespace giveway::sim {

class FaultPlan {
 public:
  explicit FaultPlan(const Scenario& scenario);

  // Logs each fault once, in the first tick in which all its conditions hold. The vehicle's true
  // pose decides; a fault of a vehicle that is not present waits.
  void Observe(double time_s, std::span<const Body> bodies, EventLog* log);

  // True once a kill of the vehicle was due: its silence is planned from then on.
  bool IsKilled(VehicleId vehicle) const;

 private:
  bool Holds(const PlannedFault& fault, double time_s, std::span<const Body> bodies) const;

  Vec2 crossing_world_;
  std::vector<PlannedFault> faults_;
  std::vector<std::uint8_t> done_;
};

}  // namespace giveway::sim

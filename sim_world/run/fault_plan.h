// Reports when a scenario's planned faults are due. The process that runs the vehicles or the
// signal heads carries them out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/body.h"
#include "sim_world/run/event_log.h"

namespace giveway::sim {

class FaultPlan {
 public:
  explicit FaultPlan(const Scenario& scenario);

  // Logs each fault once, in the first tick in which all its conditions hold, by the vehicle's true
  // pose; a fault of a vehicle that is not present waits. Returns those that are due now, valid
  // until the next call.
  std::span<const PlannedFault> Observe(double time_s, std::span<const Body> bodies, EventLog* log);

  // True once a kill of the vehicle was due, until it is back: its silence is planned.
  bool IsKilled(VehicleId vehicle) const;
  // The vehicle is heard again: its next silence is not planned.
  void Return(VehicleId vehicle);

  // Of each fault of the scenario.
  enum class State : std::uint8_t { kPending, kDue, kOver };
  std::span<const State> States() const { return states_; }
  // Those that are due again after a restart: lamps that are out stay out.
  std::vector<PlannedFault> Lasting() const;
  // Returns false, and changes nothing, unless there is one state for each fault.
  bool Restore(std::span<const State> states);

 private:
  bool Holds(const PlannedFault& fault, double time_s, std::span<const Body> bodies) const;

  Vec2 crossing_world_;
  std::vector<PlannedFault> faults_;
  std::vector<State> states_;
  std::vector<PlannedFault> due_now_;
};

}  // namespace giveway::sim

#include "sim_world/fault_plan.h"

#include <algorithm>

namespace giveway::sim {

FaultPlan::FaultPlan(const Scenario& scenario)
    : crossing_world_(scenario.crossing_world),
      faults_(scenario.faults),
      done_(scenario.faults.size()) {}

void FaultPlan::Observe(double time_s, std::span<const Body> bodies, EventLog* log) {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (done_[i] != 0 || !Holds(faults_[i], time_s, bodies)) continue;
    done_[i] = 1;
    log->Add({.kind = EventKind::kFaultDue, .vehicle = faults_[i].vehicle, .text = "kill"});
  }
}

bool FaultPlan::Holds(const PlannedFault& fault, double time_s,
                      std::span<const Body> bodies) const {
  if (fault.at_s && time_s < *fault.at_s) return false;
  const auto body = std::ranges::find(bodies, fault.vehicle, &Body::vehicle);
  if (body == bodies.end() || !body->present) return false;
  if (!fault.before_crossing_m) return true;
  const Vec2 to_crossing = crossing_world_ - body->world_from_body.position_world;
  return Norm(to_crossing) <= *fault.before_crossing_m;
}

bool FaultPlan::IsKilled(VehicleId vehicle) const {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (done_[i] != 0 && faults_[i].vehicle == vehicle && faults_[i].kind == FaultKind::kKill) {
      return true;
    }
  }
  return false;
}

}  // namespace giveway::sim

#include "sim_world/run/fault_plan.h"

#include <algorithm>

namespace giveway::sim {
namespace {

const char* NameOf(FaultKind kind) {
  switch (kind) {
    case FaultKind::kKill:
      return "kill";
    case FaultKind::kSignalDark:
      return "signal_dark";
    case FaultKind::kSignalSilent:
      return "signal_silent";
  }
  return "";
}

}  // namespace

FaultPlan::FaultPlan(const Scenario& scenario)
    : crossing_world_(scenario.crossing_world),
      faults_(scenario.faults),
      states_(scenario.faults.size()) {}

std::span<const PlannedFault> FaultPlan::Observe(double time_s, std::span<const Body> bodies,
                                                 EventLog* log) {
  due_now_.clear();
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const PlannedFault& fault = faults_[i];
    if (states_[i] != State::kPending || !Holds(fault, time_s, bodies)) continue;
    states_[i] = State::kDue;
    due_now_.push_back(fault);
    log->Add({.kind = EventKind::kFaultDue,
              .vehicle = fault.vehicle,
              .value = static_cast<double>(Number(fault.signal)),
              .text = NameOf(fault.kind)});
  }
  return due_now_;
}

bool FaultPlan::Holds(const PlannedFault& fault, double time_s,
                      std::span<const Body> bodies) const {
  if (fault.at_s && time_s < *fault.at_s) return false;
  if (fault.kind != FaultKind::kKill) return true;
  const auto body = std::ranges::find(bodies, fault.vehicle, &Body::vehicle);
  if (body == bodies.end() || !body->present) return false;
  if (!fault.before_crossing_m) return true;
  const Vec2 to_crossing = crossing_world_ - body->world_from_body.position_world;
  return Norm(to_crossing) <= *fault.before_crossing_m;
}

bool FaultPlan::IsKilled(VehicleId vehicle) const {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const bool kill = faults_[i].kind == FaultKind::kKill && faults_[i].vehicle == vehicle;
    if (kill && states_[i] == State::kDue) return true;
  }
  return false;
}

void FaultPlan::Return(VehicleId vehicle) {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const bool kill = faults_[i].kind == FaultKind::kKill && faults_[i].vehicle == vehicle;
    if (kill && states_[i] == State::kDue) states_[i] = State::kOver;
  }
}

std::vector<PlannedFault> FaultPlan::Lasting() const {
  std::vector<PlannedFault> lasting;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (states_[i] == State::kDue) lasting.push_back(faults_[i]);
  }
  return lasting;
}

bool FaultPlan::Restore(std::span<const State> states) {
  if (states.size() != states_.size()) return false;
  states_.assign(states.begin(), states.end());
  return true;
}

}  // namespace giveway::sim

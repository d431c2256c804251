#include "sim_world/run/traffic_lights.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/types/signal_plan.h"

namespace giveway::sim {

SignalHeads::SignalHeads(const Scenario& scenario) : tick_period_(scenario.tick_period) {
  for (const SignalPlan& plan : scenario.signals) heads_.push_back({.plan = plan});
  states_.reserve(heads_.size());
}

SignalState SignalHeads::Now(const Head& head, double time_s) {
  SignalState state{.id = head.plan.id,
                    .line_from_world = head.plan.line_from_world,
                    .line_to_world = head.plan.line_to_world,
                    .travel_rad = WrapAngle(head.plan.travel_rad)};
  if (head.dark) return state;
  if (time_s < 0) {
    state.phase = SignalPhase::kRed;
    return state;
  }
  const PlannedPhase planned = PhaseAt(head.plan, FromSeconds(time_s));
  state.phase = planned.phase;
  state.to_change_s = Seconds(planned.to_change);
  return state;
}

void SignalHeads::Advance(double time_s, WorldEpoch epoch, Tick tick) {
  states_.clear();
  for (Head& head : heads_) {
    if (head.silent) continue;
    SignalState state = Now(head, time_s);
    const bool changed = head.spoke == kNoTick || state.phase != head.said;
    const bool due = TicksBetween(head.spoke, tick) * tick_period_ >= kSignalPeriod;
    if (!changed && !due) continue;
    head.spoke = tick;
    head.said = state.phase;
    state.epoch = epoch;
    state.tick = tick;
    states_.push_back(state);
  }
}

bool SignalHeads::Fail(SignalId signal, FaultKind fault) {
  const auto head =
      std::ranges::find(heads_, signal, [](const Head& candidate) { return candidate.plan.id; });
  if (head == heads_.end()) return false;
  if (fault == FaultKind::kSignalDark) head->dark = true;
  if (fault == FaultKind::kSignalSilent) head->silent = true;
  return fault == FaultKind::kSignalDark || fault == FaultKind::kSignalSilent;
}

}  // namespace giveway::sim

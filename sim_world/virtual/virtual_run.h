// One virtual run from start to verdict: advances the fleet to its end under the invariants, and
// returns the result as one small value. Thousands of these make a batch.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/virtual/due_times.h"
#include "sim_world/virtual/invariants.h"
#include "sim_world/virtual/traffic.h"
#include "sim_world/virtual/virtual_fleet.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::sim {

struct VirtualOutcome {
  std::uint32_t vehicles = 0;
  std::uint32_t arrived = 0;  // stand in their goals at the end
  std::uint32_t ticks = 0;
  double tick_s = 0;           // of one tick
  double vehicle_seconds = 0;  // simulated
  std::uint32_t contacts = 0;
  std::array<std::uint32_t, kInvariantCount> violations{};
  bool held = false;                   // every invariant
  std::string unmet;                   // of the scenario's own expectations; empty: none
  std::vector<Violation> first;        // violations, in order of time
  std::vector<Violation> noted;        // of invariants that are not required, the same
  std::vector<double> delays_s;        // of those that arrived: beyond the free-flow time
  std::optional<double> clear_s;       // the last arrival, if every live vehicle arrived
  std::optional<double> separation_m;  // the closest two shells ever came
  TrafficFigures traffic;              // of all vehicles
  TrustCounters trust;                 // of all brains, as they ended
  std::uint64_t hash = 0;              // of every command and the last state
};

// The limits for the invariants of a run with this plan: what is lost or late on the radio is known
// later, and long queues wait longer.
InvariantLimits LimitsFor(const Scenario& scenario, const VirtualPlan& plan);
// The same if news may be up to so many ticks late, or lost.
InvariantLimits LimitsFor(const Scenario& scenario, std::uint32_t late_ticks, bool loses);

// The state of the fleet after a tick; `observed` has one for each vehicle of the scenario, in its
// order.
void ObserveFleet(const VirtualFleet& fleet, std::vector<Observed>* observed);

// Called after every tick, for pictures and traces.
using TickWatcher = std::function<void(const VirtualFleet& fleet)>;

VirtualOutcome RunVirtually(const Scenario& scenario, const VirtualPlan& plan,
                            const TickWatcher& watch = {});

}  // namespace giveway::sim

#include "sim_world/virtual/virtual_run.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/types/state_hash.h"
#include "services/types/time.h"
#include "sim_world/virtual/arriving.h"
#include "sim_world/virtual/virtual_faults.h"

namespace giveway::sim {
namespace {

// It stands where its goal may be by dead reckoning, and reports that it has arrived, or did so
// when the run ended: from then on it reports only that.
bool BelievesArrived(const Observed& now, bool before, const GoalTolerance& tolerance) {
  const Rule rule = now.decision.rule;
  const bool says_so = rule == Rule::kArrived || (before && rule == Rule::kNotRunning);
  return tolerance.beyond_m > 0 && says_so && Magnitude(now.forward_m_s) < kStandstill_m_s &&
         Norm(now.position_world - tolerance.at_world) <= tolerance.beyond_m;
}

// `before`: which vehicles had arrived, by the world or by themselves, in the last tick.
void NoteBelievedArrivals(std::span<const GoalTolerance> tolerances, std::vector<bool>* before,
                          std::vector<Observed>* observed) {
  for (std::size_t i = 0; i < observed->size(); ++i) {
    Observed& now = (*observed)[i];
    now.arrived = now.arrived || (now.present && BelievesArrived(now, (*before)[i], tolerances[i]));
    (*before)[i] = now.arrived;
  }
}

std::vector<double> DelaysOf(const VirtualFleet& fleet) {
  std::vector<double> delays_s;
  for (const WorldEvent& event : fleet.History()) {
    if (event.kind != EventKind::kArrived) continue;
    for (const VehicleOptions& options : fleet.TheScenario().vehicles) {
      if (options.id == event.vehicle) delays_s.push_back(event.value - FreeFlowSeconds(options));
    }
  }
  return delays_s;
}

void Conclude(const VirtualFleet& fleet, const Invariants& invariants, VirtualOutcome* outcome) {
  const RunFigures figures = fleet.World().Figures();
  outcome->ticks = figures.ticks;
  outcome->contacts = figures.contacts;
  if (!figures.passed) outcome->unmet = figures.reason;
  outcome->clear_s = figures.time_to_clear_s;
  outcome->separation_m = figures.min_separation_m;
  outcome->delays_s = DelaysOf(fleet);
  outcome->held = invariants.Held();
  outcome->first.assign(invariants.First().begin(), invariants.First().end());
  outcome->noted.assign(invariants.FirstNoted().begin(), invariants.FirstNoted().end());
  for (std::size_t i = 0; i < kInvariantCount; ++i) {
    outcome->violations[i] = invariants.Count(static_cast<Invariant>(i));
  }
  StateHash hash;
  hash.Add(figures.state_hash);
  hash.Add(fleet.CommandsHash());
  for (std::size_t i = 0; i < fleet.Size(); ++i) {
    hash.Add(fleet.Brain(i).Hash());
    outcome->trust += fleet.Brain(i).State().counters.trust;
  }
  outcome->hash = hash.Value();
}

// How long it takes through the longest of its one-lane sections.
double LongestPassageSeconds(const VehicleOptions& options) {
  double longest_m = 0;
  for (const OneLane& lane : options.one_lanes) {
    longest_m = std::max(longest_m, Norm(lane.to_world - lane.from_world));
  }
  return longest_m / options.cruise_m_s;
}

}  // namespace

void ObserveFleet(const VirtualFleet& fleet, std::vector<Observed>* observed) {
  std::size_t index = 0;
  for (const Truth& truth : fleet.World().Truths()) {
    while (index < observed->size() && (*observed)[index].vehicle != truth.vehicle) ++index;
    if (index == observed->size()) return;
    Observed& now = (*observed)[index];
    const Outputs& said = fleet.OutputsOf(index);
    now.present = truth.present;
    now.lives = fleet.Answered(index);
    now.arrived = truth.arrived;
    now.position_world = truth.world_from_body.position_world;
    now.heading_rad = truth.world_from_body.heading_rad;
    now.forward_m_s = truth.forward_m_s;
    now.rim_m_s = RimSpeed(fleet.TheScenario().vehicles[index].profile.drive, truth.wheels);
    now.answered = said.command.tick;
    now.decision = said.command.decision;
    now.gives_way_to = said.beacon.gives_way_to;
    now.order = said.beacon.order;
    now.stated = said.beacon.tick;
    now.stated_position_world = said.beacon.world_from_body.position_world;
    now.stated_covariance = said.beacon.covariance;
    now.beacon = &said.beacon;
    now.stops = said.command.target == WheelSpeeds{};
  }
}

InvariantLimits LimitsFor(const Scenario& scenario, std::uint32_t late_ticks, bool loses) {
  InvariantLimits limits;
  // The next beacon makes up for a lost one; a peer that is silent for the age limit counts as lost
  // and is not waited for.
  constexpr Nanoseconds kAgeLimit{200'000'000};
  const std::uint32_t lost = loses ? TicksCovering(kAgeLimit, scenario.tick_period) : 0;
  limits.halted_ticks += 2 * (late_ticks + lost);
  limits.cycle_ticks += late_ticks + lost;
  limits.key_age_ticks = std::min(Invariants::kRememberedKeys - 1, 2 + late_ticks + lost);
  constexpr double kWaitAlone_s = 60;
  constexpr double kWaitEach_s = 10;
  const std::size_t most = scenario.vehicles.size() + scenario.spawns.size();
  limits.wait_s = kWaitAlone_s + kWaitEach_s * static_cast<double>(most);
  // Where vehicles pass one by one, each turn lasts as long as the passage.
  for (const VehicleOptions& options : scenario.vehicles) {
    limits.wait_s += std::max(0.0, LongestPassageSeconds(options) - kWaitEach_s);
  }
  return limits;
}

InvariantLimits LimitsFor(const Scenario& scenario, const VirtualPlan& plan) {
  const RadioSettings& radio = plan.radio;
  const VirtualPlan translated = Translated(plan, scenario);
  const bool loses = radio.loss > 0 || radio.burst.enter > 0 || !radio.blackouts.empty() ||
                     radio.reorder > 0 || !translated.faults.empty() ||
                     !translated.radio.rules.empty();
  Nanoseconds late = radio.delay + radio.jitter;
  for (const RadioRule& rule : translated.radio.rules) {
    late = std::max(late, radio.delay + radio.jitter + rule.delay);
  }
  InvariantLimits limits = LimitsFor(scenario, TicksCovering(late, scenario.tick_period), loses);
  if (plan.through_m) {
    limits.one_of = WhoCanArrive(scenario).one_of;
    limits.due = DueTimes(scenario, *plan.through_m);
  }
  limits.required |= InvariantSet(plan.also_required);
  return limits;
}

VirtualOutcome RunVirtually(const Scenario& scenario, const VirtualPlan& plan,
                            const TickWatcher& watch) {
  VirtualFleet fleet(scenario, plan);
  Invariants invariants(scenario, LimitsFor(scenario, plan));
  Traffic traffic(scenario.vehicles.size(),
                  static_cast<std::uint64_t>(scenario.tick_period.count()));
  std::vector<Observed> observed;
  std::vector<GoalTolerance> tolerances;
  for (const VehicleOptions& options : scenario.vehicles) {
    observed.push_back({.vehicle = options.id});
    tolerances.push_back(ToleranceOf(options));
  }
  std::vector<bool> had_arrived(observed.size());
  VirtualOutcome outcome;
  outcome.tick_s = Seconds(scenario.tick_period);
  outcome.vehicles = static_cast<std::uint32_t>(scenario.vehicles.size());
  std::uint64_t vehicle_ticks = 0;
  for (bool goes_on = true; goes_on;) {
    goes_on = fleet.Advance();
    ObserveFleet(fleet, &observed);
    NoteBelievedArrivals(tolerances, &had_arrived, &observed);
    invariants.Observe(fleet.World().Now(), fleet.World().TimeSeconds(), observed,
                       fleet.World().Events(), {fleet.World().Obstacles(), fleet.World().Doors()});
    traffic.Observe(observed);
    vehicle_ticks += fleet.World().Scans().size();
    if (watch) watch(fleet);
  }
  invariants.Finish(fleet.World().Now(), observed);
  outcome.arrived =
      static_cast<std::uint32_t>(std::ranges::count(observed, true, &Observed::arrived));
  outcome.vehicle_seconds = static_cast<double>(vehicle_ticks) * Seconds(scenario.tick_period);
  outcome.traffic = traffic.Figures();
  Conclude(fleet, invariants, &outcome);
  return outcome;
}

}  // namespace giveway::sim

#include "services/fleetctl/soak/verb/soak_virtual.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "services/config/plan_read.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/soak/fault_clock.h"
#include "services/fleetctl/soak/fleet_course.h"
#include "services/fleetctl/soak/near_misses.h"
#include "services/fleetctl/soak/soak_session.h"
#include "services/fleetctl/soak/soak_watch.h"
#include "services/runtime/process.h"
#include "services/timing/drive_timing.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {
namespace {

using faults::Kind;
using faults::Target;
using std::chrono::seconds;

// One status every so many ticks: no value of a figure is missed between two.
constexpr std::uint32_t kStatusTicks = 4;
static_assert(kStatusTicks <= FigureSummary::kNewest);
constexpr SteadyTime kBegin = seconds(1);  // 0 is no time
constexpr Nanoseconds kProgressEvery = seconds(10);

class VirtualSoak {
 public:
  VirtualSoak(const Scenario& scenario, const faults::Schedule& schedule, const SoakPhases& phases)
      : scenario_(scenario),
        schedule_(schedule),
        phases_(phases),
        plan_{.seed = scenario.seed, .schedule = schedule},
        fleet_(scenario, plan_),
        invariants_(scenario, sim::LimitsFor(scenario, plan_)),
        watch_(SoakFleet(scenario, 0), schedule),
        clock_(schedule),
        course_(
            SoakFleet(scenario, 0), [this](VehicleId vehicle) { return away_.contains(vehicle); },
            [this](VehicleId vehicle) { return gone_.contains(vehicle); }),
        near_(RadiiOf(scenario, SoakFleet(scenario, 0))),
        near_by_block_(BlockSeconds(phases.end_s)),
        timing_(MostBeaconAge(scenario), BlockSeconds(phases.end_s)) {
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      observed_.push_back({.vehicle = vehicle.id});
      timings_.emplace_back(vehicle);
    }
  }

  SoakSeen Run() {
    seen_.started = true;
    seen_.started_at = kBegin;
    while (Time_s() < phases_.end_s && Interrupts::Count() == 0 && fleet_.Advance()) ObserveTick();
    seen_.interrupted = Interrupts::Count() > 0;
    seen_.faults_outlasted_it = !seen_.interrupted && !AreFaultsOver();
    seen_.lasted_s = Time_s();
    const auto cut_off = clock_.EndAll(Time_s());
    CarryOut(cut_off);
    for (const FaultEdge& edge : cut_off) watch_.NoteCutOff(edge.fault);
    invariants_.Finish(fleet_.World().Now(), observed_);
    Gather();
    return std::move(seen_);
  }

 private:
  double Time_s() const { return fleet_.World().TimeSeconds(); }
  bool AreFaultsOver() const { return Time_s() >= clock_.LastEnd_s(); }
  SteadyTime Now() const { return kBegin + FromSeconds(Time_s()); }

  void ObserveTick() {
    sim::ObserveFleet(fleet_, &observed_);
    invariants_.Observe(fleet_.World().Now(), Time_s(), observed_, fleet_.World().Events(),
                        {fleet_.World().Obstacles(), fleet_.World().Doors()});
    MeasureTurns();
    const link::Observed news = News();
    watch_.Fold(news, Now());
    const std::uint64_t near_before = near_.Count();
    near_.Fold(news.truths);
    near_by_block_.Note(Time_s(), near_.Count() - near_before);
    for (const VehicleStatus& status : news.statuses) timing_.Fold(status, Time_s());
    NoteEffects();
    CarryOut(clock_.TakeDue(Time_s()));
    course_.NoteModes(watch_, Now(), &seen_);
    if (AreFaultsOver()) course_.SeekHealing(watch_, Now(), &seen_);
    ShowProgress();
  }

  // In virtual time a step takes no time: jitter and cycle times come from lost ticks alone.
  void MeasureTurns() {
    for (std::size_t i = 0; i < fleet_.Size(); ++i) {
      if (!fleet_.Answered(i)) continue;
      const auto scans = fleet_.World().Scans();
      const auto scan = std::ranges::find(scans, scenario_.vehicles[i].id, &RangeScan::vehicle);
      if (scan == scans.end()) continue;
      timings_[i].Note({.woke = Now(),
                        .sent = Now(),
                        .scan = &*scan,
                        .command = fleet_.OutputsOf(i).command,
                        .evidence = fleet_.Brain(i).Evidence()});
    }
  }

  link::Observed News() {
    link::Observed news;
    const auto truths = fleet_.World().Truths();
    news.truths.assign(truths.begin(), truths.end());
    const auto events = fleet_.World().Events();
    news.events.assign(events.begin(), events.end());
    if (Number(fleet_.World().Now()) % kStatusTicks != 0) return news;
    for (std::size_t i = 0; i < fleet_.Size(); ++i) {
      if (!fleet_.Answered(i)) continue;
      VehicleStatus& status = news.statuses.emplace_back();
      status.vehicle = scenario_.vehicles[i].id;
      status.tick = fleet_.World().Now();
      status.decision = fleet_.OutputsOf(i).command.decision;
      status.gives_way_to = fleet_.OutputsOf(i).beacon.gives_way_to;
      status.forward_m_s = fleet_.Brain(i).SpeedMps();
      status.timing = timings_[i].Figures();
    }
    return news;
  }

  void CarryOut(std::span<const FaultEdge> edges) {
    for (const FaultEdge& edge : edges) {
      const faults::Fault& fault = schedule_[edge.fault];
      SetAway(fault, edge.begins);
      if (!edge.begins) {
        // Vehicles out of each other's reach exchange no beacons for it to meet.
        if (faults::ActorOf(fault.kind) == faults::Actor::kHearer)
          watch_.NoteMetNothing(edge.fault, "it met no beacon");
        watch_.NoteEnd(edge.fault, Now());
        continue;
      }
      watch_.NoteBegin(edge.fault, Now());
    }
  }

  // The world reports its own faults.
  void NoteEffects() {
    for (const std::size_t i : watch_.Open()) {
      if (!watch_.Courses()[i].effect.empty()) continue;
      const faults::Fault& fault = schedule_[i];
      const faults::Actor actor = faults::ActorOf(fault.kind);
      if (actor == faults::Actor::kHearer && fleet_.HasMetBeacons(fault)) {
        watch_.NoteEffect(i, "beacons met it");
      } else if (actor == faults::Actor::kSupervisor && HasStoppedSome(fault)) {
        watch_.NoteEffect(i, "the process missed a tick");
      }
    }
  }

  bool HasStoppedSome(const faults::Fault& fault) const {
    for (std::size_t i = 0; i < fleet_.Size(); ++i) {
      const bool meant = fault.target.what == Target::What::kAll ||
                         fault.target.vehicle == scenario_.vehicles[i].id;
      if (meant && !fleet_.Answered(i)) return true;
    }
    return false;
  }

  void SetAway(const faults::Fault& fault, bool begins) {
    if (fault.kind != Kind::kKill && fault.kind != Kind::kRestart) return;
    for (const VehicleOptions& vehicle : scenario_.vehicles) {
      if (fault.target.what != Target::What::kAll && fault.target.vehicle != vehicle.id) continue;
      if (begins) away_.insert(vehicle.id);
      if (begins && fault.kind == Kind::kKill) gone_.insert(vehicle.id);
      if (!begins && !gone_.contains(vehicle.id)) away_.erase(vehicle.id);
      watch_.SetAway(vehicle.id, away_.contains(vehicle.id));
    }
  }

  void ShowProgress() {
    if (SteadyNow() < next_progress_) return;
    next_progress_ = SteadyNow() + kProgressEvery;
    std::fprintf(stderr, "%6.0f of %.0f s of virtual time\n", Time_s(), phases_.end_s);
  }

  void Gather() {
    seen_.courses.assign(watch_.Courses().begin(), watch_.Courses().end());
    const double now_s = Time_s();
    const Tick now = fleet_.World().Now();
    seen_.broken_counted = invariants_.Broken();
    seen_.ticks_judged =
        static_cast<std::uint64_t>(std::llround(now_s / Seconds(scenario_.tick_period)));
    for (const sim::Violation& broken : invariants_.First()) {
      const double ago_s = TicksBetween(broken.tick, now) * Seconds(scenario_.tick_period);
      seen_.broken.push_back({std::max(0.0, now_s - ago_s), broken});
    }
    seen_.near_misses = near_.Narrowest();
    seen_.near_misses_counted = near_.Count();
    seen_.near_misses_by_block = near_by_block_.Counts();
    seen_.timing = timing_;
  }

  const Scenario& scenario_;
  const faults::Schedule& schedule_;
  const SoakPhases phases_;
  sim::VirtualPlan plan_;
  sim::VirtualFleet fleet_;
  sim::Invariants invariants_;
  std::vector<sim::Observed> observed_;
  SoakWatch watch_;
  FaultClock clock_;
  FleetCourse course_;
  NearMisses near_;
  BlockCounts near_by_block_;
  FleetTiming timing_;
  std::vector<DriveTiming> timings_;  // in the order of the scenario
  std::set<VehicleId> away_;
  std::set<VehicleId> gone_;
  SoakSeen seen_;
  SteadyTime next_progress_{0};
};

}  // namespace

Scenario WithPlacesFilled(Scenario scenario, std::uint32_t count) {
  const std::set<VehicleId> ids = IdsOf(scenario).joining;
  auto id = ids.begin();
  for (const VehicleOptions& place : scenario.spawns) {
    if (scenario.vehicles.size() >= count || id == ids.end()) break;
    scenario.vehicles.push_back(place);
    scenario.vehicles.back().id = *id++;
  }
  std::ranges::sort(scenario.vehicles, {}, &VehicleOptions::id);
  scenario.spawns.clear();
  return scenario;
}

SoakSeen RunSoakVirtually(const Scenario& scenario, const faults::Schedule& schedule,
                          const SoakPhases& phases) {
  return VirtualSoak(scenario, schedule, phases).Run();
}

}  // namespace giveway::fleetctl

#include "services/fleetctl/virtual/virtual_case.h"

#include <algorithm>
#include <set>

#include "services/config/faults/fault_sources.h"
#include "services/config/plan_read.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/config/start_rules.h"
#include "services/faults/expand.h"
#include "services/faults/unsupported.h"

namespace giveway::fleetctl {
namespace {

constexpr WholeRange kDefaultVehicles{6, 6};
constexpr std::uint64_t kDraws = 0x5eed;   // a stream separate from the generators'
constexpr std::uint64_t kRobots = 0xb0d1;  // and that for robots
constexpr double kMeanBurst_ticks = 5;
// Faults fall into the time in which paths cross.
constexpr NumberRange kFaultTime_s{2, 25};
constexpr NumberRange kAbsence_s{0.1, 0.8};  // the world treats a second of silence as a death

std::uint32_t Draw(const WholeRange& range, Random* dice) {
  return range.low + static_cast<std::uint32_t>(dice->Next() % (range.high - range.low + 1ULL));
}

sim::RadioSettings RadioOf(const CaseOptions& options, Random* dice) {
  sim::RadioSettings radio;
  const double loss = dice->Uniform(options.loss_percent.low, options.loss_percent.high) / 100;
  if (options.burst && loss > 0) {
    // Links are bad for the share of time that equals the loss, and then lose everything.
    radio.burst.leave = 1 / kMeanBurst_ticks;
    radio.burst.enter = std::min(0.8, radio.burst.leave * loss / (1 - loss));
  } else {
    radio.loss = loss;
  }
  radio.delay = FromSeconds(options.delay_ms / 1000);
  radio.jitter = FromSeconds(options.jitter_ms / 1000);
  radio.reorder = options.reorder_percent / 100;
  radio.duplicate = options.duplicate_percent / 100;
  radio.loops_back = options.loops_back;
  return radio;
}

// An open fleet at its start: the first to join gets the first place.
void FillPlaces(std::uint32_t count, Scenario* scenario) {
  const std::set<VehicleId> ids = IdsOf(*scenario).joining;
  auto id = ids.begin();
  for (const VehicleOptions& place : scenario->spawns) {
    if (scenario->vehicles.size() >= count) break;
    scenario->vehicles.push_back(place);
    scenario->vehicles.back().id = *id++;
  }
  std::ranges::sort(scenario->vehicles, {}, &VehicleOptions::id);
  scenario->spawns.clear();
}

void AddFaults(sim::ProcessFaultKind kind, const WholeRange& range, const Scenario& scenario,
               Random* dice, std::vector<sim::ProcessFault>* faults) {
  // A fixed number draws nothing: seeds mean what they meant before there were ranges.
  const std::uint32_t count = range.low == range.high ? range.low : Draw(range, dice);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t chosen = dice->Next() % scenario.vehicles.size();
    faults->push_back({.kind = kind,
                       .vehicle = scenario.vehicles[chosen].id,
                       .at_s = dice->Uniform(kFaultTime_s.low, kFaultTime_s.high),
                       .for_s = dice->Uniform(kAbsence_s.low, kAbsence_s.high)});
  }
}

void AddNamed(const sim::ProcessFault& fault, VirtualCase* made) {
  const auto& vehicles = made->scenario.vehicles;
  if (std::ranges::find(vehicles, fault.vehicle, &VehicleOptions::id) == vehicles.end()) {
    throw InputError({{.file = made->scenario.name,
                       .field = "--fault",
                       .value = std::to_string(Number(fault.vehicle)),
                       .message = "no vehicle has this id",
                       .remedy = "name one of the scenario's"}});
  }
  made->plan.faults.push_back(fault);
}

// One fault per rule, for its kind and target.
faults::Schedule AskedFor(const faults::FaultFile& file) {
  using What = faults::Target::What;
  using Targets = faults::Targets::What;
  faults::Schedule asked;
  for (const faults::AtRule& rule : file.at) {
    asked.push_back({.rule = rule.name, .kind = rule.kind, .target = rule.target});
  }
  for (const faults::RandomRule& rule : file.random) {
    const What what = rule.targets.what == Targets::kWorld             ? What::kWorld
                      : rule.targets.what == Targets::kDiscoveryServer ? What::kDiscoveryServer
                                                                       : What::kAll;
    asked.push_back({.rule = rule.name, .kind = rule.kind, .target = {.what = what}});
  }
  return asked;
}

}  // namespace

CaseMaker::CaseMaker(const CaseOptions& options) : options_(options) {
  generator_ = sim::FindGenerator(options.scenario);
  if (generator_ != nullptr) {
    name_ = generator_->name;
    TakeFaults(std::nullopt);
    return;
  }
  ScenarioOverrides overrides;
  overrides.seed = 0;
  overrides.duration_s = options.duration_s;
  overrides.behaviour = options.behaviour;
  ScenarioWithFaults loaded = LoadScenarioWithFaults(options.scenario, overrides);
  loaded_ = std::move(loaded.scenario);
  if (IsEndless(*loaded_)) loaded_->duration_s = kEndless_s;
  name_ = loaded_->name;
  CheckVehicles();
  CheckFleet();
  TakeFaults(loaded.faults);
}

void CaseMaker::CheckVehicles() const {
  if (!options_.vehicles) return;
  const std::size_t most = loaded_->vehicles.size() + loaded_->spawns.size();
  const bool open = !loaded_->spawns.empty();
  if (open && options_.vehicles->high <= most) return;
  throw InputError(
      {{.file = name_,
        .field = "--vehicles",
        .value = std::to_string(options_.vehicles->high),
        .message = open ? "it has places for " + std::to_string(most) : "it names its vehicles",
        .remedy = open ? "ask for no more" : "leave the flag out"}});
}

void CaseMaker::CheckFleet() const {
  if (!options_.fleet.mixed_robots) return;
  throw InputError({{.file = name_,
                     .field = "--robots",
                     .value = "mixed",
                     .message = "it names its vehicles, and what they are",
                     .remedy = "leave the flag out, or run a generator"}});
}

void CaseMaker::TakeFaults(const std::optional<faults::FaultFile>& own) {
  sources_ = LoadFaultSources(own, options_.fault_file);
  const auto incapable = faults::IncapableInVirtualTime();
  std::vector<Problem> problems;
  for (const faults::FaultFile& file : sources_) {
    for (const faults::Unsupported& kind : faults::UnsupportedIn(AskedFor(file), incapable)) {
      const std::string word(faults::ToString(kind.kind));
      problems.push_back({.file = file.name,
                          .field = kind.rules.front(),
                          .value = word,
                          .message = kind.reason,
                          .remedy = "leave it out, or add --skip-unsupported"});
      left_out_ += file.name + ": " + word + " is left out: " + kind.reason + "\n";
    }
  }
  if (!problems.empty() && !options_.skip_unsupported) throw InputError(std::move(problems));
  rules_ = Together(sources_);
}

faults::Schedule CaseMaker::ScheduleOf(const Scenario& scenario, std::uint32_t seed) const {
  if (!HasFaults()) return {};
  std::vector<VehicleId> ids;
  for (const VehicleOptions& vehicle : scenario.vehicles) ids.push_back(vehicle.id);
  const auto course = faults::CourseOfRun(rules_, scenario.duration_s, seed);
  const auto expansion = faults::Expand(rules_, course, ids);
  std::vector<Problem> problems = ProblemsOf(sources_, expansion);
  if (!problems.empty()) throw InputError(std::move(problems));
  return faults::Without(expansion.schedule, faults::IncapableInVirtualTime());
}

std::string CaseMaker::Remark() const {
  if (!loaded_ || loaded_->impairment.rules.empty()) return left_out_;
  return left_out_ + name_ +
         ": its `impair` is not carried out, that is for real links; the virtual radio is set by "
         "--loss, --burst, --delay, --jitter, --reorder and --duplicate\n";
}

Scenario CaseMaker::MakeScenario(std::uint32_t seed, Random* dice) const {
  const std::uint32_t vehicles = Draw(options_.vehicles.value_or(kDefaultVehicles), dice);
  FleetDraw fleet(options_.fleet, generator_ != nullptr ? generator_->most_radius_m : 0,
                  (options_.delay_ms + options_.jitter_ms) / 1000, Random(seed, kRobots));
  const auto draw = [&](VehicleOptions* options) { fleet.Take(options); };
  Scenario scenario = loaded_ ? *loaded_ : generator_->make({vehicles, seed, draw});
  scenario.sonar = fleet.Sonar(scenario.sonar);
  if (loaded_) {
    std::ranges::for_each(scenario.vehicles, [&](auto& vehicle) { fleet.Take(&vehicle); });
    std::ranges::for_each(scenario.spawns, [&](auto& place) { fleet.Take(&place); });
    FillPlaces(options_.vehicles ? vehicles : std::max(1U, scenario.start_with), &scenario);
    scenario.seed = seed;
    PerturbWithinRules(name_, &scenario);
  }
  scenario.seed = options_.sensor_seed.value_or(scenario.seed);  // nothing is moved any more
  if (!loaded_ && options_.behaviour) {
    for (VehicleOptions& vehicle : scenario.vehicles) {
      vehicle.behaviour = *options_.behaviour;
      vehicle.braitenberg = WeightsOf(*options_.behaviour);
    }
  }
  return scenario;
}

VirtualCase CaseMaker::Make(std::uint32_t seed) const {
  Random dice(seed, kDraws);
  VirtualCase made{MakeScenario(seed, &dice), {}};
  made.plan.seed = options_.radio_seed.value_or(seed);
  made.plan.also_required = options_.also_required;
  made.plan.through_m =
      generator_ != nullptr ? sim::ThroughMetres(*generator_, made.scenario) : options_.through_m;
  made.plan.radio = RadioOf(options_, &dice);
  using Kind = sim::ProcessFaultKind;
  AddFaults(Kind::kCrash, options_.crashes, made.scenario, &dice, &made.plan.faults);
  AddFaults(Kind::kPause, options_.pauses, made.scenario, &dice, &made.plan.faults);
  AddFaults(Kind::kRestart, options_.restarts, made.scenario, &dice, &made.plan.faults);
  for (const sim::ProcessFault& fault : options_.faults) AddNamed(fault, &made);
  made.plan.schedule = ScheduleOf(made.scenario, seed);
  return made;
}

}  // namespace giveway::fleetctl

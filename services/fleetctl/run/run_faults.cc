#include "services/fleetctl/run/run_faults.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "services/config/faults/fault_sources.h"
#include "services/config/problem.h"
#include "services/faults/channel.h"
#include "services/faults/expand.h"
#include "services/faults/unsupported.h"

namespace giveway::fleetctl {
namespace {

using faults::Actor;
using faults::Kind;

constexpr double kLatestPlanned_s = 86400;  // of a `fault` of a scenario

// A kill is planned in the scenario: the world says when it is due, by its own time.
std::string WhyNoKill(const Scenario& scenario, bool of_vehicle, double at_s) {
  if (!of_vehicle) return "only a soak kills what is no vehicle";
  if (!scenario.spawns.empty()) return "in an open fleet only a soak kills";
  return at_s > kLatestPlanned_s ? "a run kills in its first day only" : "";
}

std::string WhyNot(Kind kind, const Scenario& scenario, bool of_vehicle, double at_s) {
  if (kind == Kind::kKill) return WhyNoKill(scenario, of_vehicle, at_s);
  const Actor actor = faults::ActorOf(kind);
  return actor == Actor::kWorld || actor == Actor::kHearer ? "" : "only a soak carries it out";
}

class Refusals {
 public:
  explicit Refusals(const std::string& file) : file_(file) {}

  template <typename Rule>
  void Check(const Rule& rule, const std::string& why) {
    if (!why.empty()) Add(rule.name, rule.line, rule.kind, why, "use fleetctl soak, or remove it");
  }
  void Add(const std::string& rule, int line, Kind kind, const std::string& why,
           const std::string& remedy) {
    problems_.Add({.file = file_,
                   .line = line,
                   .field = rule,
                   .value = std::string(faults::ToString(kind)),
                   .message = "cannot be carried out in a run: " + why,
                   .remedy = remedy});
  }
  void ThrowIfAny() const {
    if (!problems_.Empty()) throw InputError(problems_.Sorted());
  }

 private:
  std::string file_;
  ProblemList problems_;
};

void RefuseRules(const faults::FaultFile& own, const Scenario& scenario) {
  Refusals refusals(own.name);
  for (const faults::AtRule& rule : own.at) {
    const bool of_vehicle = rule.target.what == faults::Target::What::kVehicle;
    refusals.Check(rule, WhyNot(rule.kind, scenario, of_vehicle, rule.time_s));
  }
  for (const faults::RandomRule& rule : own.random) {
    const bool of_vehicle = rule.targets.what != faults::Targets::What::kDiscoveryServer;
    refusals.Check(rule, WhyNot(rule.kind, scenario, of_vehicle, 0));
    if (!IsEndless(scenario)) continue;
    refusals.Add(rule.name, rule.line, rule.kind, "one without an end draws no faults",
                 "give --duration");
  }
  refusals.ThrowIfAny();
}

// Each rule once.
void RefuseWhatVehiclesLack(const faults::FaultFile& own, const faults::Schedule& schedule,
                            const Scenario& scenario) {
  const faults::Incapable incapable = faults::IncapableWithSensorsOf(scenario);
  Refusals refusals(own.name);
  std::set<std::string> refused;
  for (const faults::Fault& fault : schedule) {
    const auto cannot = faults::UnsupportedIn({fault}, incapable);
    const std::string why =
        cannot.empty() ? faults::WhyTargetLacks(fault, scenario) : cannot.front().reason;
    if (why.empty() || !refused.insert(fault.rule).second) continue;
    refusals.Add(fault.rule, 0, fault.kind, why, "remove it");
  }
  refusals.ThrowIfAny();
}

}  // namespace

RunFaults FaultsOfRun(const faults::FaultFile& own, const Scenario& scenario,
                      std::span<const VehicleId> fleet, const Impairment& always) {
  RefuseRules(own, scenario);
  const auto course = faults::CourseOfRun(own, scenario.duration_s, scenario.seed);
  const faults::Schedule schedule = ExpandFaults({&own, 1}, course, fleet).schedule;
  RefuseWhatVehiclesLack(own, schedule, scenario);
  RunFaults run;
  run.heard = faults::ImpairmentWith(schedule, fleet, always);
  for (const faults::Fault& fault : schedule) {
    if (faults::ActorOf(fault.kind) == Actor::kWorld) run.worlds.push_back(fault);
    if (fault.kind != Kind::kKill) continue;
    run.kills.push_back(
        {.kind = FaultKind::kKill, .vehicle = fault.target.vehicle, .at_s = fault.at_s});
  }
  return run;
}

}  // namespace giveway::fleetctl

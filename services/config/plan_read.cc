#include "services/config/plan_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "services/config/vehicle_read.h"

namespace giveway {
namespace {

// The kind of the one target a fault names.
FaultKind ReadKind(const Section& section) {
  const int named = static_cast<int>(section.Has("kill")) + static_cast<int>(section.Has("dark")) +
                    static_cast<int>(section.Has("silent"));
  if (named != 1) {
    section.AddError(
        "", fmt::format("names {} of kill, dark and silent", named == 0 ? "none" : "more than one"),
        "write exactly one of them");
  }
  if (section.Has("kill")) return FaultKind::kKill;
  return section.Has("dark") ? FaultKind::kSignalDark : FaultKind::kSignalSilent;
}

void ReadSignalFault(const Section& section, const KnownIds& known, PlannedFault* fault) {
  for (const char* field : {"dark", "silent"}) {
    if (!section.Has(field)) continue;
    fault->signal = SignalId{section.Uint(field, kId)};
    if (fault->signal != kNoSignal && !known.signals.contains(fault->signal)) {
      section.AddError(field, "no signal has this id", "name the id of a signal of this file");
    }
  }
  if (section.Has("before_crossing_m")) {
    section.AddError("before_crossing_m", "is a condition of kill only", "write at_s: instead");
  } else if (!section.Has("at_s")) {
    section.AddMissingError("at_s", "write at_s: with the seconds since the start signal");
  }
}

void ReadKill(const Section& section, const Section& root, const KnownIds& known,
              PlannedFault* fault) {
  fault->vehicle = VehicleId{section.Uint("kill", kId)};
  if (fault->vehicle != kNoVehicle && !known.vehicles.contains(fault->vehicle)) {
    section.AddError("kill", "no vehicle has this id", "name the id of a vehicle of this file");
  }
  if (section.Has("before_crossing_m")) {
    fault->before_crossing_m = section.Number("before_crossing_m", {0, 1000, "m", true});
    if (!root.Has("crossing")) {
      section.AddError("before_crossing_m", "the scenario names no crossing",
                       "write crossing { x_m: y_m: } in the scenario");
    }
  }
  if (!fault->at_s && !fault->before_crossing_m) {
    section.AddError("", "the fault has no condition", "write at_s: or before_crossing_m:");
  }
}

// A sorted set of ids, each one known and named once.
std::vector<VehicleId> ReadIds(const Section& section, const char* field, const KnownIds& known) {
  std::set<VehicleId> ids;
  const std::vector<double> numbers = section.Numbers(field, kId, kMaxVehicles);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::isnan(numbers[i])) continue;
    const VehicleId id{static_cast<std::uint32_t>(numbers[i])};
    const int index = static_cast<int>(i);
    if (!known.vehicles.contains(id) && !known.joining.contains(id)) {
      section.AddError(field, fmt::format("no vehicle has the id {}", Number(id)),
                       "name ids of vehicles of this file", index);
    } else if (!ids.insert(id).second) {
      section.AddError(field, fmt::format("names {} twice", Number(id)), "name each id once",
                       index);
    }
  }
  return {ids.begin(), ids.end()};
}

// True if a set of ids is not judged; then there is none to name.
bool ReadAny(const Section& section, const char* field, const char* ids) {
  const bool any = section.FlagOr(false, field);
  if (any && section.Has(ids)) {
    section.AddError(field, fmt::format("is given together with {}", ids), "remove one of the two");
  }
  return any;
}

// A vehicle that is expected to arrive needs a goal; one that joins may get any of the spawn
// places.
void CheckGoals(const Section& section, const KnownIds& known, const Scenario& scenario,
                const std::vector<VehicleId>& arrived) {
  const auto expected = [&](VehicleId id) {
    return std::binary_search(arrived.begin(), arrived.end(), id);
  };
  const auto add_error = [&](VehicleId id) {
    section.AddError(
        "arrived",
        fmt::format("vehicle {} has no goal, or a route that loops, and never arrives", Number(id)),
        "give it a goal and no loop, or leave it out here");
  };
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    if (!HasGoal(vehicle) && expected(vehicle.id)) add_error(vehicle.id);
  }
  const auto& spawns = scenario.spawns;
  if (std::any_of(spawns.begin(), spawns.end(), HasGoal)) return;
  for (const VehicleId id : known.joining) {
    if (expected(id)) add_error(id);
  }
}

// Why a vehicle halts; at least one must then be allowed to.
std::optional<Rule> ReadReason(const Section& section, const Expectation& expect) {
  constexpr std::array kAsNumberedInTheSchema = {Rule::kGiveWay, Rule::kNotGranted, Rule::kPeerLost,
                                                 Rule::kUnidentifiedMotion};
  const std::optional<int> reason = section.Enum("halted_for");
  if (!reason) return std::nullopt;
  if (expect.halted.empty() && !expect.any_halted) {
    section.AddError("halted_for", "is given, and no vehicle is expected to halt",
                     "write halted or any_halted, or remove it");
  }
  return kAsNumberedInTheSchema[static_cast<std::size_t>(*reason)];
}

}  // namespace

KnownIds IdsOf(const Scenario& scenario) {
  KnownIds known;
  for (const VehicleOptions& vehicle : scenario.vehicles) known.vehicles.insert(vehicle.id);
  for (const SignalPlan& signal : scenario.signals) known.signals.insert(signal.id);
  for (std::uint32_t id = 1; known.joining.size() < scenario.spawns.size(); ++id) {
    if (!known.vehicles.contains(VehicleId{id})) known.joining.insert(VehicleId{id});
  }
  return known;
}

PlannedFault ReadFault(const Section& section, const Section& root, const KnownIds& known) {
  PlannedFault fault{.kind = ReadKind(section)};
  if (section.Has("at_s")) fault.at_s = section.Number("at_s", {0, 86400, "s"});
  if (section.Has("kill")) ReadKill(section, root, known, &fault);
  if (section.Has("dark") || section.Has("silent")) ReadSignalFault(section, known, &fault);
  return fault;
}

Expectation ReadExpectation(const Section& section, const KnownIds& known,
                            const Scenario& scenario) {
  Expectation expect;
  expect.contacts = section.UintOr(0, "contacts", kWholeNumber);
  expect.halted = ReadIds(section, "halted", known);
  expect.arrived = ReadIds(section, "arrived", known);
  expect.any_halted = ReadAny(section, "any_halted", "halted");
  expect.any_arrived = ReadAny(section, "any_arrived", "arrived");
  expect.halted_for = ReadReason(section, expect);
  expect.parted = section.FlagOr(false, "parted");
  if (section.Has("min_separation_m")) {
    expect.min_separation_m = section.Number("min_separation_m", {0, 10000, "m"});
  }
  if (section.Has("time_to_clear_s")) {
    expect.time_to_clear_s = section.Number("time_to_clear_s", kDuration);
  }
  CheckGoals(section, known, scenario, expect.arrived);
  return expect;
}

}  // namespace giveway

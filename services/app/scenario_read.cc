#include "services/app/scenario_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "services/app/vehicle_read.h"

namespace giveway::app {
namespace {

constexpr Allowed kWholeNumber{0, 4294967295.0};
constexpr int kMaxVehicles = 1024;
constexpr Allowed kDuration{0, 86400, "s", true};

// [a-z0-9_-]+: area names become DDS partitions, and names become file names.
std::string ReadName(const Section& root, const char* field, std::string fallback) {
  if (!root.Has(field)) return fallback;
  const std::string name = root.Text(field);
  const bool clean = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!clean || name.empty() || name.size() > 64) {
    root.Complain(field, "must be 1 to 64 of the characters a-z 0-9 _ -", "choose another name");
  }
  return name;
}

// Shown on terminals: no control characters.
std::string ReadDescription(const Section& root) {
  const std::string text = root.Text("description");
  const bool clean = std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
  if (!clean) root.Complain("description", "holds control characters", "write one plain paragraph");
  return text;
}

Nanoseconds ReadMilliseconds(const Section& root, const char* field, const Allowed& allowed,
                             Nanoseconds fallback) {
  const double ms = root.NumberOr(Milliseconds(fallback), field, allowed);
  return std::isnan(ms) ? fallback : FromSeconds(ms / 1000);
}

// Ticks and gates that all vehicles share.
VehicleOptions ReadCommon(const Section& root) {
  VehicleOptions common;
  common.profile = PioneerP3dx();
  ReadProfile(root.Sub("profile"), &common.profile);
  common.behaviour = ReadBehaviour(root).value_or(common.behaviour);
  common.beacon_age_limit =
      ReadMilliseconds(root, "beacon_age_limit_ms", {15, 10000, "ms"}, common.beacon_age_limit);
  common.tick_period =
      ReadMilliseconds(root, "tick_period_ms", {5, 1000, "ms"}, common.tick_period);
  // One beacon may be lost and the next late before a peer counts as silent.
  if (3 * common.tick_period > common.beacon_age_limit) {
    root.Complain(
        root.Has("tick_period_ms") ? "tick_period_ms" : "beacon_age_limit_ms",
        fmt::format("a beacon every {} ms cannot be guarded by an age limit of {} ms: "
                    "three ticks must fit",
                    Milliseconds(common.tick_period), Milliseconds(common.beacon_age_limit)),
        "shorten tick_period_ms or raise beacon_age_limit_ms");
  }
  common.ranges_age_limit = 3 * common.tick_period;
  common.emission_radius_m =
      root.NumberOr(common.emission_radius_m, "emission_radius_m", {0, 1000, "m", true});
  common.gate_enter_m = root.NumberOr(common.gate_enter_m, "gate_enter_m", {0, 100, "m", true});
  common.gate_exit_m = root.NumberOr(common.gate_exit_m, "gate_exit_m", {0, 100, "m", true});
  if (common.gate_enter_m >= common.gate_exit_m) {
    root.Complain(root.Has("gate_enter_m") ? "gate_enter_m" : "gate_exit_m",
                  fmt::format("the entry gate ({} m) must be below the exit gate ({} m)",
                              common.gate_enter_m, common.gate_exit_m),
                  "lower gate_enter_m or raise gate_exit_m");
  }
  return common;
}

void ReadSettings(const Section& root, const ScenarioOverrides& overrides, Scenario* scenario) {
  if (!root.Has("name")) root.ComplainMissing("name", "write name: \"...\"");
  scenario->name = ReadName(root, "name", "");
  scenario->description = ReadDescription(root);
  scenario->area = ReadName(root, "area", scenario->area);
  scenario->seed = overrides.seed.value_or(root.WholeOr(scenario->seed, "seed", kWholeNumber));
  const double written_s = root.NumberOr(scenario->duration_s, "duration_s", kDuration);
  scenario->duration_s = overrides.duration_s.value_or(written_s);
  if (overrides.duration_s && !kDuration.Contains(*overrides.duration_s)) {
    root.Complain("",
                  fmt::format("the duration asked for instead, {} s, must be {}",
                              *overrides.duration_s, Describe(kDuration)),
                  "give another duration");
  }
  scenario->start_timeout_s =
      root.NumberOr(scenario->start_timeout_s, "start_timeout_s", {0, 600, "s", true});
  scenario->remove_after_s =
      root.NumberOr(scenario->remove_after_s, "remove_after_s", {0, 3600, "s"});
  scenario->watchdog_ticks =
      root.WholeOr(scenario->watchdog_ticks, "watchdog_ticks", {1, 100, "ticks"});
  if (const auto crossing = root.Sub("crossing")) scenario->crossing_world = ReadPoint(*crossing);
}

// The sections of a repeated field, or none where there are too many to look at.
std::vector<Section> Elements(const Section& root, const char* field, int most) {
  const int count = root.Count(field);
  if (count <= most) return root.Subs(field);
  root.Complain("", fmt::format("has {} of {}; at most {} are allowed", count, field, most),
                "leave some out");
  return {};
}

Wall ReadWall(const Section& section) {
  const auto end = [&](const char* field) {
    const auto point = section.RequiredSub(field);
    return point ? ReadPoint(*point) : Vec2{kUnusable, kUnusable};
  };
  const Wall wall{end("from"), end("to")};
  if (wall.from_world == wall.to_world) {
    section.Complain("", "the wall has no length: from and to are the same point",
                     "move one end, or remove the wall");
  }
  return wall;
}

using Ids = std::set<VehicleId>;

PlannedFault ReadFault(const Section& section, const Section& root, const Ids& known) {
  PlannedFault fault;
  fault.vehicle = VehicleId{section.Whole("kill", kId)};
  if (fault.vehicle != kNobody && !known.contains(fault.vehicle)) {
    section.Complain("kill", "no vehicle has this id", "name the id of a vehicle of this file");
  }
  if (section.Has("at_s")) fault.at_s = section.Number("at_s", {0, 86400, "s"});
  if (section.Has("before_crossing_m")) {
    fault.before_crossing_m = section.Number("before_crossing_m", {0, 1000, "m", true});
    if (!root.Has("crossing")) {
      section.Complain("before_crossing_m", "the scenario names no crossing",
                       "write crossing { x_m: y_m: } in the scenario");
    }
  }
  if (!fault.at_s && !fault.before_crossing_m) {
    section.Complain("", "the fault has no condition", "write at_s: or before_crossing_m:");
  }
  return fault;
}

// A sorted set of ids, each one known and named once.
std::vector<VehicleId> ReadIds(const Section& section, const char* field, const Ids& known) {
  std::vector<VehicleId> ids;
  const std::vector<double> numbers = section.Numbers(field, kId, kMaxVehicles);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::isnan(numbers[i])) continue;
    const VehicleId id{static_cast<std::uint32_t>(numbers[i])};
    const int index = static_cast<int>(i);
    if (!known.contains(id)) {
      section.Complain(field, fmt::format("no vehicle has the id {}", Number(id)),
                       "name ids of vehicles of this file", index);
    } else if (std::find(ids.begin(), ids.end(), id) != ids.end()) {
      section.Complain(field, fmt::format("names {} twice", Number(id)), "name each id once",
                       index);
    }
    ids.push_back(id);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

Expectation ReadExpectation(const Section& section, const Ids& known,
                            const std::vector<VehicleOptions>& vehicles) {
  Expectation expect;
  expect.contacts = section.WholeOr(0, "contacts", kWholeNumber);
  expect.halted = ReadIds(section, "halted", known);
  expect.arrived = ReadIds(section, "arrived", known);
  expect.parted = section.FlagOr(false, "parted");
  if (section.Has("min_separation_m")) {
    expect.min_separation_m = section.Number("min_separation_m", {0, 10000, "m"});
  }
  if (section.Has("time_to_clear_s")) {
    expect.time_to_clear_s = section.Number("time_to_clear_s", kDuration);
  }
  for (const VehicleOptions& vehicle : vehicles) {
    if (!vehicle.goal.set &&
        std::binary_search(expect.arrived.begin(), expect.arrived.end(), vehicle.id)) {
      section.Complain("arrived",
                       fmt::format("vehicle {} has no goal and never arrives", Number(vehicle.id)),
                       "give it a goal, or leave it out here");
    }
  }
  return expect;
}

// Vehicles sorted by id, with their sections.
void ReadVehicles(const Section& root, const ScenarioOverrides& overrides, ReadScenario* read) {
  struct Pair {
    VehicleOptions options;
    Section section;
  };
  std::vector<Pair> pairs;
  const VehicleOptions common = ReadCommon(root);
  read->scenario.tick_period = common.tick_period;
  if (!root.Has("vehicle")) root.ComplainMissing("vehicle", "write vehicle { ... } at least once");
  for (const Section& section : Elements(root, "vehicle", kMaxVehicles)) {
    pairs.push_back({ReadVehicle(section, common, overrides.behaviour), section});
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.options.id < b.options.id; });
  for (Pair& pair : pairs) {
    const auto& before = read->scenario.vehicles;
    if (pair.options.id != kNobody && !before.empty() && before.back().id == pair.options.id) {
      pair.section.Complain("id", "another vehicle has this id too",
                            "give each vehicle its own id");
    }
    read->scenario.vehicles.push_back(pair.options);
    read->vehicles.push_back(pair.section);
  }
}

}  // namespace

ReadScenario ReadFrom(const Section& root, const ScenarioOverrides& overrides) {
  ReadScenario read;
  Scenario& scenario = read.scenario;
  ReadSettings(root, overrides, &scenario);
  ReadVehicles(root, overrides, &read);
  Ids known;
  for (const VehicleOptions& vehicle : scenario.vehicles) known.insert(vehicle.id);
  for (const Section& wall : Elements(root, "wall", 4096)) {
    scenario.walls.push_back(ReadWall(wall));
  }
  for (const Section& fault : Elements(root, "fault", 1024)) {
    scenario.faults.push_back(ReadFault(fault, root, known));
  }
  if (const auto expect = root.RequiredSub("expect")) {
    scenario.expect = ReadExpectation(*expect, known, scenario.vehicles);
  }
  CheckStarts(read, "");
  return read;
}

}  // namespace giveway::app

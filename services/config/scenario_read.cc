#include "services/config/scenario_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "services/config/faults/faults_read.h"
#include "services/config/impair.h"
#include "services/config/place_read.h"
#include "services/config/plan_read.h"
#include "services/config/pose_read.h"
#include "services/config/vehicle_read.h"
#include "services/types/fleet_limits.h"
#include "services/types/signal_plan.h"

namespace giveway {
namespace {

constexpr int kMaxWalls = 65536;
constexpr int kMaxObstacles = 16384;
constexpr int kMaxDoors = 1024;
constexpr int kMaxSignals = 1024;
constexpr int kMaxFaults = 1024;

// [a-z0-9_-]+: area names become DDS partitions, and names become file names.
std::string ReadName(const Section& root, const char* field, std::string fallback) {
  if (!root.Has(field)) return fallback;
  const std::string name = root.Text(field);
  const bool clean = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!clean || name.empty() || name.size() > 64) {
    root.AddError(field, "must be 1 to 64 of the characters a-z 0-9 _ -", "choose another name");
  }
  return name;
}

// Shown on terminals: no control characters.
std::string ReadDescription(const Section& root) {
  const std::string text = root.Text("description");
  const bool clean = std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
  if (!clean) root.AddError("description", "holds control characters", "write one plain paragraph");
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
  ReadProfile(root.Child("profile"), &common.profile);
  common.behaviour = ReadBehaviour(root).value_or(common.behaviour);
  common.beacon_age_limit =
      ReadMilliseconds(root, "beacon_age_limit_ms", {15, 10000, "ms"}, common.beacon_age_limit);
  common.tick_period =
      ReadMilliseconds(root, "tick_period_ms", {5, 1000, "ms"}, common.tick_period);
  // One beacon may be lost and the next late before a peer counts as silent.
  if (3 * common.tick_period > common.beacon_age_limit) {
    root.AddError(
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
    root.AddError(root.Has("gate_enter_m") ? "gate_enter_m" : "gate_exit_m",
                  fmt::format("the entry gate ({} m) must be below the exit gate ({} m)",
                              common.gate_enter_m, common.gate_exit_m),
                  "lower gate_enter_m or raise gate_exit_m");
  }
  return common;
}

void ReadSettings(const Section& root, const ScenarioOverrides& overrides, Scenario* scenario) {
  if (!root.Has("name")) root.AddMissingError("name", "write name: \"...\"");
  scenario->name = ReadName(root, "name", "");
  scenario->description = ReadDescription(root);
  scenario->area = ReadName(root, "area", scenario->area);
  scenario->seed = overrides.seed.value_or(root.UintOr(scenario->seed, "seed", kWholeNumber));
  const double written_s =
      root.NumberOr(scenario->duration_s, "duration_s", {kDuration.low, kDuration.high, "s"});
  scenario->duration_s = overrides.duration_s.value_or(written_s);
  if (overrides.duration_s && !kDuration.Contains(*overrides.duration_s)) {
    root.AddError("",
                  fmt::format("the duration asked for instead, {} s, must be {}",
                              *overrides.duration_s, Describe(kDuration)),
                  "give another duration");
  }
  scenario->start_timeout_s =
      root.NumberOr(scenario->start_timeout_s, "start_timeout_s", {0, 600, "s", true});
  scenario->remove_after_s =
      root.NumberOr(scenario->remove_after_s, "remove_after_s", {0, 3600, "s"});
  scenario->watchdog_ticks =
      root.UintOr(scenario->watchdog_ticks, "watchdog_ticks", {1, 100, "ticks"});
  if (const auto crossing = root.Child("crossing")) scenario->crossing_world = ReadPoint(*crossing);
}

// The sections of a repeated field, or none where there are too many to look at.
std::vector<Section> Elements(const Section& root, const char* field, int most) {
  const int count = root.Count(field);
  if (count <= most) return root.Children(field);
  root.AddError(field, fmt::format("is one of {}; at most {} are allowed", count, most),
                "leave some out", most);
  return {};
}

// Sorts by id a list of which each element has its section, and refuses ids that stand twice.
template <typename T>
void SortById(std::vector<T>* values, std::vector<Section>* sections, const char* what) {
  std::vector<std::size_t> order(values->size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return (*values)[a].id < (*values)[b].id; });
  std::vector<T> sorted_values;
  std::vector<Section> sorted_sections;
  for (const std::size_t i : order) {
    const T& value = (*values)[i];
    if (Number(value.id) != 0 && !sorted_values.empty() && sorted_values.back().id == value.id) {
      (*sections)[i].AddError("id", fmt::format("another {} has this id too", what),
                              fmt::format("give each {} its own id", what));
    }
    sorted_values.push_back(value);
    sorted_sections.push_back((*sections)[i]);
  }
  *values = std::move(sorted_values);
  *sections = std::move(sorted_sections);
}

void ReadStartWith(const Section& root, Scenario* scenario) {
  const std::size_t named = scenario->vehicles.size();
  if (scenario->spawns.empty()) {
    if (!root.Has("start_with")) return;
    root.AddError("start_with", "is for an open fleet, and there is no spawn",
                  "write spawn { ... }, or remove it");
    return;
  }
  if (named > kMaxOpenFleet) {
    root.AddError("vehicle",
                  fmt::format("is one of {}; an open fleet has at most {} at any one time", named,
                              kMaxOpenFleet),
                  "leave some out, or every spawn", kMaxOpenFleet);
  }
  const std::size_t all = std::min<std::size_t>(named + scenario->spawns.size(), kMaxOpenFleet);
  scenario->start_with = root.UintOr(static_cast<std::uint32_t>(std::max<std::size_t>(named, 1)),
                                     "start_with", {1, static_cast<double>(all), "vehicles"});
}

// The map that all vehicles share.
void ReadMap(const Section& root, ReadScenario* read) {
  read->one_lanes = Elements(root, "one_lane", static_cast<int>(kMaxOneLanes));
  for (const Section& lane : read->one_lanes) {
    read->scenario.one_lanes.push_back(ReadOneLane(lane));
  }
}

void ReadFleet(const Section& root, const ScenarioOverrides& overrides, ReadScenario* read) {
  Scenario& scenario = read->scenario;
  VehicleOptions common = ReadCommon(root);
  common.one_lanes = scenario.one_lanes;
  if (!std::isnan(scenario.remove_after_s)) {  // else refused
    common.silent_body_stays = SilenceIn(common.tick_period) + FromSeconds(scenario.remove_after_s);
  }
  scenario.tick_period = common.tick_period;
  scenario.sonar = ReadSonar(root.Child("sonar"), common.tick_period);
  common.sonar_refresh = SonarRefresh(scenario.sonar, common.tick_period);
  common.sonar_noise = scenario.sonar.tier == SonarTier::kIdeal ? 0 : scenario.sonar.noise;
  if (!root.Has("vehicle") && !root.Has("spawn")) {
    root.AddMissingError("vehicle", "write vehicle { ... } or spawn { ... } at least once");
  }
  read->vehicles = Elements(root, "vehicle", kMaxVehicles);
  read->spawns = Elements(root, "spawn", kMaxVehicles);
  if (read->vehicles.size() + read->spawns.size() > kMaxVehicles) {
    root.AddError("",
                  fmt::format("has {} of vehicle and spawn together; at most {} are allowed",
                              read->vehicles.size() + read->spawns.size(), kMaxVehicles),
                  "leave some out");
  }
  PoseLimits limits(root.Child("profile"));
  for (const Section& section : read->vehicles) {
    scenario.vehicles.push_back(ReadVehicle(section, common, overrides.behaviour));
    limits.Settle(section.Child("profile"), &scenario.vehicles.back().profile);
  }
  SortById(&scenario.vehicles, &read->vehicles, "vehicle");
  for (const Section& section : read->spawns) {
    scenario.spawns.push_back(ReadSpawn(section, common, overrides.behaviour));
    limits.Settle(section.Child("profile"), &scenario.spawns.back().profile);
  }
  ReadStartWith(root, &scenario);
}

// Of each group, every head that may show green or yellow while an earlier one does.
void CheckGroups(const std::vector<SignalPlan>& signals, const std::vector<Section>& sections) {
  std::map<std::uint32_t, std::vector<const SignalPlan*>> groups;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const SignalPlan& signal = signals[i];
    // A refused number is a problem already.
    if (signal.group == 0 ||
        !std::isfinite(signal.green_s + signal.yellow_s + signal.red_s + signal.offset_s)) {
      continue;
    }
    auto& heads = groups[signal.group];
    const auto other = std::find_if(heads.begin(), heads.end(), [&](const SignalPlan* head) {
      return ShowGreenTogether(*head, signal);
    });
    if (other != heads.end()) {
      sections[i].AddError(
          "group",
          fmt::format("signals {} and {} of this group are green or yellow at one time",
                      Number((*other)->id), Number(signal.id)),
          "change their times, give both the same cycle, or take one out of the group");
    }
    heads.push_back(&signal);
  }
}

void ReadSignals(const Section& root, Scenario* scenario) {
  std::vector<Section> sections = Elements(root, "signal", kMaxSignals);
  for (const Section& section : sections) scenario->signals.push_back(ReadSignal(section));
  SortById(&scenario->signals, &sections, "signal");
  CheckGroups(scenario->signals, sections);
}

void ReadPlace(const Section& root, ReadScenario* read) {
  Scenario& scenario = read->scenario;
  for (const Section& wall : Elements(root, "wall", kMaxWalls)) {
    scenario.walls.push_back(ReadWall(wall));
  }
  read->obstacles = Elements(root, "obstacle", kMaxObstacles);
  for (const Section& obstacle : read->obstacles) {
    scenario.obstacles.push_back(ReadObstacle(obstacle));
  }
  read->doors = Elements(root, "door", kMaxDoors);
  for (const Section& door : read->doors) scenario.doors.push_back(ReadDoor(door));
  ReadSignals(root, &scenario);
}

void ReadImpairment(const Section& root, const KnownIds& known, Impairment* impairment) {
  for (const Section& rule : Elements(root, "impair", kMaxImpairRules)) {
    impairment->rules.push_back(ReadImpairmentRule(rule, known));
  }
  if (!root.Has("impair_seed")) return;
  impairment->seed = root.Uint("impair_seed", kWholeNumber);
  if (!root.Has("impair")) {
    root.AddError("impair_seed", "is given, and nothing is impaired",
                  "write impair { ... }, or remove it");
  }
}

void ReadPlans(const Section& root, ReadScenario* read) {
  Scenario* const scenario = &read->scenario;
  const KnownIds known = IdsOf(*scenario);
  ReadImpairment(root, known, &scenario->impairment);
  for (const Section& fault : Elements(root, "fault", kMaxFaults)) {
    scenario->faults.push_back(ReadFault(fault, root, known));
  }
  if (const auto faults = root.Child("faults")) read->faults = ReadFaultFile(*faults);
  if (const auto expect = root.RequiredChild("expect")) {
    scenario->expect = ReadExpectation(*expect, known, *scenario);
  }
}

}  // namespace

ReadScenario ReadFrom(const Section& root, const ScenarioOverrides& overrides) {
  ReadScenario read;
  ReadSettings(root, overrides, &read.scenario);
  ReadMap(root, &read);
  ReadFleet(root, overrides, &read);
  ReadPlace(root, &read);
  ReadPlans(root, &read);
  return read;
}

}  // namespace giveway

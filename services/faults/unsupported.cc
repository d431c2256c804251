#include "services/faults/unsupported.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "services/faults/kind_table.h"

namespace giveway::faults {

namespace {

constexpr std::array kNeedPoseFixes = {Kind::kEncoderWrong, Kind::kPoseFixLost,
                                       Kind::kPoseFixWrong};

// Null: it can be carried out.
const std::string* WhyNot(const Fault& fault, const Incapable& incapable) {
  if (const auto kind = incapable.kinds.find(fault.kind); kind != incapable.kinds.end()) {
    return &kind->second;
  }
  const auto target = incapable.targets.find(fault.target.what);
  return target == incapable.targets.end() ? nullptr : &target->second;
}

}  // namespace

std::vector<Unsupported> UnsupportedIn(const Schedule& schedule, const Incapable& incapable) {
  struct Asked {
    std::set<std::string> rules;
    std::size_t faults = 0;
  };
  std::map<std::pair<Kind, std::string>, Asked> refused;
  for (const Fault& fault : schedule) {
    const std::string* reason = WhyNot(fault, incapable);
    if (reason == nullptr) continue;
    Asked& asked = refused[{fault.kind, *reason}];
    asked.rules.insert(fault.rule);
    ++asked.faults;
  }
  std::vector<Unsupported> listed;
  for (const auto& [what, asked] : refused) {
    listed.push_back(
        {what.first, what.second, {asked.rules.begin(), asked.rules.end()}, asked.faults});
  }
  return listed;
}

Schedule Without(const Schedule& schedule, const Incapable& incapable) {
  Schedule rest;
  std::ranges::copy_if(schedule, std::back_inserter(rest),
                       [&](const Fault& fault) { return WhyNot(fault, incapable) == nullptr; });
  return rest;
}

Incapable IncapableWithSensorsOf(const Scenario& scenario) {
  const auto fitted = [](const VehicleOptions& vehicle) {
    return vehicle.profile.pose_fix.Fitted();
  };
  if (std::ranges::any_of(scenario.vehicles, fitted) ||
      std::ranges::any_of(scenario.spawns, fitted)) {
    return {};
  }
  Incapable incapable;
  for (const Kind kind : kNeedPoseFixes) {
    incapable.kinds[kind] = "no vehicle of this scenario has pose fixes (sensors.pose_fix)";
  }
  return incapable;
}

std::string WhyTargetLacks(const Fault& fault, const Scenario& scenario) {
  const bool needs_fixes = std::ranges::find(kNeedPoseFixes, fault.kind) != kNeedPoseFixes.end();
  if (!needs_fixes || fault.target.what != Target::What::kVehicle) return {};
  const auto named =
      std::ranges::find(scenario.vehicles, fault.target.vehicle, &VehicleOptions::id);
  if (named == scenario.vehicles.end() || named->profile.pose_fix.Fitted()) return {};
  return "vehicle " + std::to_string(Number(named->id)) + " has no pose fixes (sensors.pose_fix)";
}

Incapable IncapableInVirtualTime() {
  Incapable incapable;
  for (const KindRow& row : KindTable()) {
    if (row.in_virtual_time) continue;
    incapable.kinds[row.kind] =
        "the virtual fleet has no " + std::string(ToString(row.actor)) + " that could";
  }
  for (const auto what : {Target::What::kWorld, Target::What::kDiscoveryServer}) {
    incapable.targets[what] = "it is no process in virtual time";
  }
  return incapable;
}

}  // namespace giveway::faults

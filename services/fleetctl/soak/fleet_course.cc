#include "services/fleetctl/soak/fleet_course.h"

#include <algorithm>

namespace giveway::fleetctl {

std::vector<VehicleId> SoakFleet(const Scenario& scenario, std::uint32_t newcomers) {
  std::vector<VehicleId> fleet;
  for (const VehicleOptions& vehicle : scenario.vehicles) fleet.push_back(vehicle.id);
  for (std::uint32_t id = 1; id <= newcomers; ++id) fleet.push_back(VehicleId{id});
  return fleet;
}

std::string FleetCourse::ModeOf(const SoakWatch& watch, VehicleId vehicle, SteadyTime now) const {
  if (is_away_(vehicle)) return "gone";
  const VehicleStatus* const status = watch.StatusOf(vehicle);
  if (status == nullptr) return "silent";
  return watch.IsWell(vehicle, now) ? "drive" : std::string(Name(status->decision.rule));
}

void FleetCourse::NoteModes(const SoakWatch& watch, SteadyTime now, SoakSeen* seen) {
  for (const VehicleId vehicle : fleet_) {
    std::string mode = ModeOf(watch, vehicle, now);
    std::string& before = mode_[vehicle];
    if (before == mode) continue;
    before = mode;
    ++seen->modes_counted;
    if (seen->modes.size() < kMostListed) {
      seen->modes.push_back({watch.TimeSeconds(now), vehicle, std::move(mode)});
    }
  }
}

void FleetCourse::SeekHealing(const SoakWatch& watch, SteadyTime now, SoakSeen* seen) {
  if (!healed_from_) healed_from_ = now;
  for (const VehicleId vehicle : fleet_) {
    if (is_gone_(vehicle)) {  // also one that was killed last of all, and had not ended yet
      seen->healing.erase(vehicle);
      seen->silent_s.erase(vehicle);
      continue;
    }
    const SteadyTime status_at = std::max(watch.StatusAt(vehicle), *healed_from_);
    double& silent_s = seen->silent_s[vehicle];
    silent_s = std::max(silent_s, Seconds(now - status_at));
    // Its earlier reports do not count: it may have been deaf, or unheard, since.
    auto& healed = seen->healing[vehicle];
    if (!healed && status_at > *healed_from_ && watch.IsWell(vehicle, now)) {
      healed = Seconds(now - *healed_from_);
    }
  }
}

}  // namespace giveway::fleetctl

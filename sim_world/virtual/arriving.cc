#include "sim_world/virtual/arriving.h"

#include <algorithm>
#include <numeric>

#include "services/types/math/math.h"
#include "sim_world/virtual/due_times.h"

namespace giveway::sim {
namespace {

bool ExcludeEachOther(const VehicleOptions& a, const VehicleOptions& b) {
  // Each may stand off its goal by the goal's radius, away from the other.
  const double apart_m = Norm(a.goal.at_world - b.goal.at_world);
  return apart_m + a.goal.radius_m + b.goal.radius_m <
         a.profile.body_radius_m + b.profile.body_radius_m;
}

}  // namespace

// Each wheel has a new error in each tick, a share of what it rolls, so that the heading is a
// random walk and the lateral offset its sum.
GoalTolerance ToleranceOf(const VehicleOptions& options) {
  constexpr double kSigmas = 3;
  constexpr double kDetour = 1.5;
  const RobotModel& profile = options.profile;
  const double squared =
      profile.wheel_slip * profile.wheel_slip + profile.encoder_noise * profile.encoder_noise;
  const PoseFixModel& fixes = profile.pose_fix;
  if (!HasGoal(options)) return {};
  if (fixes.Fitted()) {
    return {options.goal.at_world, options.goal.radius_m + kSigmas * fixes.sigma_m};
  }
  if (profile.pose_limit_m > 0 && (squared > 0 || profile.wheel_error.Any())) {
    return {options.goal.at_world, options.goal.radius_m + kSigmas * profile.pose_limit_m};
  }
  if (squared == 0) return {};
  const double route_length_m = kDetour * RouteLength(options);
  const double tick_m = options.cruise_m_s * Seconds(options.tick_period);
  const double heading_rad = Sqrt(2 * squared) * tick_m / profile.drive.axle_m;
  const double beside_m = heading_rad * route_length_m * Sqrt(route_length_m / tick_m / 3);
  return {options.goal.at_world, options.goal.radius_m + kSigmas * beside_m};
}

// A vehicle belongs to the first group whose first member excludes it.
Arriving WhoCanArrive(const Scenario& scenario) {
  std::vector<const VehicleOptions*> firsts;
  std::vector<std::vector<VehicleId>> groups;
  for (const VehicleOptions& options : scenario.vehicles) {
    if (!HasGoal(options)) continue;
    const auto first = std::ranges::find_if(
        firsts, [&](const VehicleOptions* other) { return ExcludeEachOther(options, *other); });
    if (first != firsts.end()) {
      groups[static_cast<std::size_t>(first - firsts.begin())].push_back(options.id);
      continue;
    }
    firsts.push_back(&options);
    groups.push_back({options.id});
  }
  Arriving arriving;
  for (std::vector<VehicleId>& group : groups) {
    if (group.size() == 1) {
      arriving.each.push_back(group.front());
    } else {
      arriving.one_of.push_back(std::move(group));
    }
  }
  return arriving;
}

}  // namespace giveway::sim

#include "sim_world/virtual/due_times.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway::sim {
namespace {

constexpr double kAnyway_s = 20;  // steering is not a straight line
// A vehicle is not blamed for turning less than its body could.
constexpr double kShareOfTurnRate = 0.5;

// Through the place from standstill before it.
double PassageSeconds(const VehicleOptions& options, double through_m) {
  return through_m / options.cruise_m_s +
         options.cruise_m_s / (2 * options.profile.acceleration_m_s2);
}

}  // namespace

double RouteLength(const VehicleOptions& options) {
  double length_m = 0;
  Vec2 at = options.start_world.position_world;
  for (std::uint32_t i = 0; i < options.route.count; ++i) {
    length_m += Norm(options.route.waypoints_world[i] - at);
    at = options.route.waypoints_world[i];
  }
  return length_m + Norm(options.goal.at_world - at);
}

double FreeFlowSeconds(const VehicleOptions& options) {
  const double route_length_m = std::max(0.0, RouteLength(options) - options.goal.radius_m);
  const double cruise = options.cruise_m_s;
  return route_length_m / cruise + cruise / (2 * options.profile.acceleration_m_s2) +
         cruise / (2 * options.profile.deceleration_m_s2);
}

// At each turn it may stop, and speed up again.
double AloneSeconds(const VehicleOptions& options) {
  double turned_rad = 0;
  Vec2 at = options.start_world.position_world;
  double heading_rad = options.start_world.heading_rad;
  const auto turn_to = [&](Vec2 next) {
    const Vec2 displacement = next - at;
    if (SquaredNorm(displacement) < 1e-6) return;
    const double next_rad = Atan2(displacement.y, displacement.x);
    turned_rad += Magnitude(WrapAngle(next_rad - heading_rad));
    heading_rad = next_rad;
    at = next;
  };
  for (std::uint32_t i = 0; i < options.route.count; ++i) {
    turn_to(options.route.waypoints_world[i]);
  }
  turn_to(options.goal.at_world);
  const double stop_s = options.cruise_m_s / (2 * options.profile.acceleration_m_s2) +
                        options.cruise_m_s / (2 * options.profile.deceleration_m_s2);
  return FreeFlowSeconds(options) +
         turned_rad / (kShareOfTurnRate * options.profile.max_turn_rad_s) +
         stop_s * options.route.count;
}

std::vector<DueTime> DueTimes(const Scenario& scenario, double through_m) {
  double all_s = 0;
  for (const VehicleOptions& options : scenario.vehicles)
    all_s += PassageSeconds(options, through_m);
  std::vector<DueTime> due;
  for (const VehicleOptions& options : scenario.vehicles) {
    if (!HasGoal(options)) continue;
    const double others_s = all_s - PassageSeconds(options, through_m);
    due.push_back({options.id, AloneSeconds(options) + kAnyway_s + others_s});
  }
  return due;
}

}  // namespace giveway::sim

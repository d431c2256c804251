#include "services/config/writing/scenario_rounding.h"

#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"

namespace giveway {
namespace {

double Thousandths(double value) { return std::round(value * 1000) / 1000; }
Vec2 Thousandths(Vec2 point) { return {Thousandths(point.x), Thousandths(point.y)}; }
double Heading(double heading_rad) { return WrapAngle(Radians(Thousandths(Degrees(heading_rad)))); }
Pose Thousandths(const Pose& pose) {
  return {Thousandths(pose.position_world), Heading(pose.heading_rad)};
}

template <typename Ends>
void RoundEnds(Ends* ends) {
  ends->from_world = Thousandths(ends->from_world);
  ends->to_world = Thousandths(ends->to_world);
}

// Of a box the radius follows.
void RoundBody(BodyShape shape, Vec2* box_half_m, double* radius_m) {
  *box_half_m = Thousandths(*box_half_m);
  *radius_m = shape == BodyShape::kBox ? Norm(*box_half_m) : Thousandths(*radius_m);
}

// Errors of wheels and sensors have more digits that matter.
void RoundRobot(RobotModel* profile) {
  RoundBody(profile->shape, &profile->box_half_m, &profile->body_radius_m);
  for (double* const value : {&profile->max_speed_m_s, &profile->max_turn_rad_s,
                              &profile->acceleration_m_s2, &profile->deceleration_m_s2}) {
    *value = Thousandths(*value);
  }
}

void RoundDriver(VehicleOptions* options) {
  RoundRobot(&options->profile);
  options->start_world = Thousandths(options->start_world);
  options->cruise_m_s = std::min(Thousandths(options->cruise_m_s), options->profile.max_speed_m_s);
  options->goal.at_world = Thousandths(options->goal.at_world);
  for (Vec2& waypoint : options->route.waypoints_world) waypoint = Thousandths(waypoint);
}

}  // namespace

Scenario Rounded(Scenario scenario) {
  scenario.duration_s = Thousandths(scenario.duration_s);
  for (OneLane& lane : scenario.one_lanes) {
    RoundEnds(&lane);
    lane.width_m = Thousandths(lane.width_m);
  }
  for (auto* const drivers : {&scenario.vehicles, &scenario.spawns}) {
    for (VehicleOptions& options : *drivers) {
      RoundDriver(&options);
      options.one_lanes = scenario.one_lanes;
    }
  }
  std::ranges::for_each(scenario.walls, [](Wall& wall) { RoundEnds(&wall); });
  std::ranges::for_each(scenario.doors, [](Door& door) { RoundEnds(&door); });
  for (Obstacle& obstacle : scenario.obstacles) {
    RoundBody(obstacle.shape, &obstacle.box_half_m, &obstacle.radius_m);
    obstacle.start_world = Thousandths(obstacle.start_world);
    for (Vec2& waypoint : obstacle.waypoints_world) waypoint = Thousandths(waypoint);
  }
  for (SignalPlan& signal : scenario.signals) {
    signal.line_from_world = Thousandths(signal.line_from_world);
    signal.line_to_world = Thousandths(signal.line_to_world);
    signal.travel_rad = Heading(signal.travel_rad);
  }
  return scenario;
}

}  // namespace giveway

#include "services/vehicle/steering.h"

#include <algorithm>

#include "services/types/math.h"

namespace giveway {
namespace {

// Between two shells when one steers round the other.
constexpr double kRoundMargin_m = 0.15;

// Between the two centres when one passes the other.
double Clearance(const PeerView& view, const Situation& s) {
  return s.options.profile.body_radius_m + view.peer->beacon.body_radius_m + kRoundMargin_m;
}

// The nearest standing peer that keeps still for us and blocks the straight way to the goal.
const PeerView* Blocking(const Situation& s) {
  const PeerView* nearest = nullptr;
  for (const PeerView& view : s.peers) {
    const double clearance_m = Clearance(view, s);
    if (!view.fresh || !view.standing || !view.grants || view.goes_first) continue;
    if (view.at_signal) continue;  // a queue at a light is no place to overtake
    const Vec2 offset = view.world_from_body.position_world - s.path.from_world;
    const double along = Dot(offset, s.path.direction_world);
    const double across = Cross(s.path.direction_world, offset);
    const bool ahead = along > 0 && along < s.distance_to_goal_m + clearance_m;
    const bool blocks = across < clearance_m && across > -clearance_m;
    if (!ahead || !blocks) continue;
    if (nearest == nullptr || view.gap_m < nearest->gap_m) nearest = &view;
  }
  return nearest;
}

// The heading of the tangent past a disc of `clearance_m` round `centre`, on the side nearer to
// `goal_heading`; passing on the right where both sides are alike.
double TangentHeading(const Situation& s, Vec2 centre_world, double clearance_m,
                      double goal_heading) {
  const Vec2 offset = centre_world - s.world_from_body.position_world;
  const double distance = Norm(offset);
  const double to_centre = Atan2(offset.y, offset.x);
  const double reach = Sqrt(std::max(0.0, distance * distance - clearance_m * clearance_m));
  // Inside the disc there is no tangent: drive square to it and a little away.
  const double opening = distance > clearance_m ? Atan2(clearance_m, reach) : kPi / 2 + Radians(10);
  const double goal_side = WrapAngle(goal_heading - to_centre);
  return to_centre + (goal_side > Radians(3) ? opening : -opening);
}

double Activation(const BraitenbergWeights& weights, const SensorView& view) {
  if (view.kind != Echo::kEcho || view.range_m >= weights.far_gate_m) return 0;
  const double range = std::max(view.range_m, weights.near_gate_m);
  return 1 - (range - weights.near_gate_m) / (weights.far_gate_m - weights.near_gate_m);
}

}  // namespace

Steering SteerToGoal(const Situation& s) {
  Steering steering;
  double heading = Atan2(s.path.direction_world.y, s.path.direction_world.x);
  if (const PeerView* view = Blocking(s)) {
    heading = TangentHeading(s, view->world_from_body.position_world, Clearance(*view, s), heading);
    steering.round = view->peer->id;
  }
  steering.heading_error_rad = WrapAngle(heading - s.world_from_body.heading_rad);
  return steering;
}

Avoidance Avoid(const BraitenbergWeights& weights, const RangeView& ranges) {
  Avoidance avoidance{.wheels = {weights.base_rad_s, weights.base_rad_s}};
  double strongest = 0;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const double activation = Activation(weights, ranges[i]);
    avoidance.wheels.left_rad_s += weights.left[i] * activation;
    avoidance.wheels.right_rad_s += weights.right[i] * activation;
    if (activation > strongest) {
      strongest = activation;
      avoidance.sensor = static_cast<int>(i);
    }
  }
  return avoidance;
}

WheelSpeeds Drive(const VehicleProfile& profile, const Steering& steering, double speed_m_s,
                  bool may_turn) {
  if (speed_m_s <= 0 && !may_turn) return {};
  constexpr double kGain_per_s = 2.0;
  constexpr double kTurnOnTheSpot_rad = 0.3;
  const double error = steering.heading_error_rad;
  const double turn =
      std::clamp(kGain_per_s * error, -profile.max_turn_rad_s / 2, profile.max_turn_rad_s / 2);
  const bool on_the_spot = error > kTurnOnTheSpot_rad || error < -kTurnOnTheSpot_rad;
  return WheelsFromTwist(profile.drive, {on_the_spot ? 0 : speed_m_s, turn});
}

}  // namespace giveway

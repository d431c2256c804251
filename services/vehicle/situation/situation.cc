#include "services/vehicle/situation/situation.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/situation/claim.h"

namespace giveway {
namespace {

// What a beacon says of its target: further off it is the direction alone that peers need.
constexpr double kLongestPath_m = 1000;

// Of the distance between the two centres: only what lies along it counts.
double SigmaBetween(const CarriedPeer& view) {
  if (view.distance_m <= 0) return view.sigma_m;
  return SigmaAlong(view.apart, (1 / view.distance_m) * view.offset_world);
}

}  // namespace

double OwnStoppingDistance(const OwnView& s) {
  const double speed = std::max(0.0, s.speed_m_s);
  return StoppingDistance(speed, s.reaction_s + Seconds(s.options.tick_period),
                          s.options.profile.deceleration_m_s2) +
         kInHand_m;
}

double OwnSweep(const OwnMotion& s, const PoseCovariance& covariance,
                const VehicleOptions& options) {
  const double speed = std::max(0.0, s.speed_m_s);
  const double steady_s = Seconds(options.tick_period) + s.reaction_s;
  const double deceleration_m_s2 = options.profile.deceleration_m_s2;
  return StoppingDistance(speed, steady_s, deceleration_m_s2) *
         SwingOf(s.turn_rad_s, steady_s, speed, deceleration_m_s2, covariance);
}

double StoppingDistanceOf(const CarriedPeer& view, const OwnView& s) {
  return StoppingDistance(std::max(0.0, view.speed_m_s), s.reaction_s,
                          view.peer->beacon.deceleration_m_s2);
}

double CriticalDistance(const OwnView& s, const CarriedPeer& view) {
  const double own = StoppingDistance(std::max(0.0, s.speed_m_s), s.reaction_s,
                                      s.options.profile.deceleration_m_s2);
  const double both = own + StoppingDistanceOf(view, s);
  return std::max(s.options.gate_enter_m, both + kBodiesMargin_m + kSigmas * SigmaBetween(view));
}

double RoomBeside(const CarriedPeer& view, const OwnView& s) {
  // Between the two shells; less than the distance at which a vehicle halts before the own path, so
  // that this one drives past it and not round it.
  constexpr double kRoundMargin_m = 0.12;
  // A lost vehicle may stand away from where it says that it does.
  const double unsure_m = view.peer->beacon.rule == Rule::kLost ? kSigmas * view.sigma_m : 0;
  return s.options.profile.body_radius_m + view.peer->beacon.body_radius_m + kRoundMargin_m +
         unsure_m;
}

Vec2 Toward(const OwnView& s) {
  if (s.arrived || s.lost) return s.world_from_body.position_world;
  const double path_m = std::min(s.distance_to_goal_m, kLongestPath_m);
  return s.world_from_body.position_world + path_m * s.path.direction_world;
}

bool Occupies(const CarriedPeer& view, Vec2 point_world, const OwnView& s) {
  const double room_m =
      s.options.profile.body_radius_m + view.peer->beacon.body_radius_m + kPassingMargin_m;
  return SquaredNorm(view.position_world - point_world) < room_m * room_m;
}

bool IsOnGoalOf(const CarriedPeer& view, const OwnView& s) {
  const Beacon& beacon = view.peer->beacon;
  const double room_m = s.options.profile.body_radius_m + beacon.body_radius_m + kPassingMargin_m;
  return SquaredNorm(beacon.toward_world - s.world_from_body.position_world) < room_m * room_m;
}

Vec2 VelocityOf(const CarriedPeer& view) { return view.speed_m_s * view.forward_world; }

double ClosingSpeed(const CarriedPeer& view, const OwnView& s) {
  const Vec2 velocity = VelocityOf(view) - s.speed_m_s * s.forward_world;
  return view.distance_m > 0 ? -Dot(view.offset_world, velocity) / view.distance_m : 0;
}

}  // namespace giveway

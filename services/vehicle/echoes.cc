#include "services/vehicle/echoes.h"

#include <algorithm>

#include "services/types/math.h"

namespace giveway {
namespace {

constexpr double kPathMargin_m = 0.05;      // on either side of the body
constexpr double kSameBody_m = 0.25;        // an echo this near to the expected range is that body
constexpr double kOwnMotion_m_s = 0.15;     // closing speed the own motion may leave unexplained
constexpr std::uint32_t kMotionStreak = 4;  // readings in a row before a closing speed counts

double Magnitude(double x) { return x < 0 ? -x : x; }

// How far straight on until the own disc touches a disc at `centre_body`; empty if it passes.
std::optional<double> FreeBeforeDisc(Vec2 centre_body, double sum_of_radii) {
  if (centre_body.x <= 0) return std::nullopt;
  const double half = (sum_of_radii + kPathMargin_m) * (sum_of_radii + kPathMargin_m) -
                      centre_body.y * centre_body.y;
  if (half <= 0) return std::nullopt;
  return std::max(0.0, centre_body.x - Sqrt(half));
}

// The point of the cone's arc at `range_m` that lies nearest to the body's x axis.
Vec2 ArcPointNearestAxis(const SensorMount& mount, double half_angle, double range_m) {
  const double bearing = mount.bearing_rad;
  const double straight = bearing > half_angle    ? bearing - half_angle
                          : bearing < -half_angle ? bearing + half_angle
                                                  : 0;
  return mount.position_body + range_m * Vec2{Cos(straight), Sin(straight)};
}

// Where a peer comes to stand if it brakes as soon as this vehicle does.
Vec2 WhereItStops(const PeerView& peer, const Situation& s) {
  const double braking_m =
      StoppingDistance(std::max(0.0, peer.speed_m_s), ReactionSeconds(s.options),
                       s.options.profile.deceleration_m_s2);
  const double on_m = peer.closing_m_s > 0 ? braking_m : 0;
  return peer.world_from_body.position_world + on_m * peer.forward_world;
}

}  // namespace

std::uint32_t EchoesOf(Vec2 centre_world, double radius_m, const Situation& s) {
  const VehicleProfile& profile = s.options.profile;
  const Vec2 centre = InBody(s, centre_world);
  std::uint32_t explains = 0;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const SensorView& view = s.ranges[i];
    if (view.kind != Echo::kEcho) continue;
    const Vec2 to_centre = centre - profile.sonar[i].position_body;
    const double distance = Norm(to_centre);
    const double expected = distance - radius_m;
    if (Magnitude(view.range_m - expected) > kSameBody_m) continue;
    // The body shows from one tangent to the other; half the body more allows for uncertainty.
    const double off_axis =
        Magnitude(WrapAngle(Atan2(to_centre.y, to_centre.x) - profile.sonar[i].bearing_rad));
    const double half_width = distance > 1.5 * radius_m ? 1.5 * radius_m / distance : kPi;
    if (off_axis <= profile.sonar_half_angle_rad + half_width) explains |= 1U << i;
  }
  return explains;
}

std::optional<double> FreeAhead(std::size_t sensor, const Situation& s) {
  const SensorView& view = s.ranges[sensor];
  const VehicleProfile& profile = s.options.profile;
  if (view.kind != Echo::kEcho || profile.sonar[sensor].position_body.x < 0) return std::nullopt;
  for (const PeerView& peer : s.peers) {
    if ((peer.explains >> sensor & 1U) == 0) continue;
    // Its claim says more than its echo: rules.cc, KeepClear.
    if (s.options.behaviour == Behaviour::kCooperative && peer.fresh) return std::nullopt;
    return FreeBeforeDisc(InBody(s, WhereItStops(peer, s)),
                          profile.body_radius_m + peer.peer->beacon.body_radius_m);
  }
  const Vec2 echo =
      ArcPointNearestAxis(profile.sonar[sensor], profile.sonar_half_angle_rad, view.range_m);
  return FreeBeforeDisc(echo, profile.body_radius_m);
}

bool MovesByItself(std::size_t sensor, const Situation& s) {
  const SensorView& view = s.ranges[sensor];
  if (view.kind != Echo::kEcho || view.streak < kMotionStreak) return false;
  const VehicleProfile& profile = s.options.profile;
  const double off_axis =
      std::max(0.0, Magnitude(profile.sonar[sensor].bearing_rad) - profile.sonar_half_angle_rad);
  const double by_driving = std::max(0.0, s.speed_m_s * Cos(off_axis));
  const double by_turning = Magnitude(s.turn_rad_s) * (profile.body_radius_m + 0.3 * view.range_m);
  return view.closing_m_s > by_driving + by_turning + kOwnMotion_m_s;
}

}  // namespace giveway

#include "services/vehicle/situation/echoes.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/situation/claim.h"

namespace giveway {
namespace {

constexpr double kPathMargin_m = 0.05;   // on either side of the body
constexpr double kNearer_m = 0.06;       // but not nearer than by this and what is unsure
constexpr double kOwnMotion_m_s = 0.15;  // closing speed the own motion may leave unexplained
// Readings in a row before a closing speed counts; where each takes its time, fewer must do.
constexpr std::uint32_t kMotionStreak = 4;
constexpr std::uint32_t kSlowMotionStreak = 2;
// A cone with a direction nearer to the heading than 60 degrees looks ahead.
constexpr double kLooksAhead = 0.5;

// How far a direction is off a cone's axis.
double OffAxis(Vec2 direction_body, const Cone& cone) {
  return Magnitude(WrapAngle(Atan2(direction_body.y, direction_body.x) - cone.bearing_rad));
}

// A body's centre as a sensor has it before it.
struct Sight {
  Vec2 to_body;     // from the sensor
  double along_m;   // the cone's axis
  double across_m;  // the cone's axis, on either side
};

Sight Seen(Vec2 to_body, const Cone& cone) {
  return {to_body, Dot(cone.axis_body, to_body), Magnitude(Cross(cone.axis_body, to_body))};
}

// Whether a direction is off a cone's axis by no more than limit_rad. The sine of an angle is less
// than the angle and its tangent more: what lies between takes the angle itself.
bool IsWithin(double limit_rad, const Sight& centre, double distance_m, const Cone& cone) {
  constexpr double kRounding = 1e-9;  // of products and roots of doubles
  if (limit_rad < 1.5) {
    if (centre.along_m < 0) return false;
    if (centre.across_m > (limit_rad + kRounding) * distance_m) return false;
    if (centre.across_m < (limit_rad - kRounding) * centre.along_m) return true;
  }
  return OffAxis(centre.to_body, cone) <= limit_rad;
}

// The least range at which a cone that looks `off_rad` past the centre of a disc echoes it, metres
// from the sensor: at its nearest point inside the cone, or else where its edge meets it or passes.
double LeastRange(double distance_m, double radius_m, double off_rad) {
  if (distance_m <= radius_m) return 0;
  if (off_rad <= 0) return distance_m - radius_m;
  const double across_m = distance_m * Sin(std::min(off_rad, kPi / 2));
  if (across_m >= radius_m) return Sqrt(distance_m * distance_m - radius_m * radius_m);
  return distance_m * Cos(off_rad) - Sqrt(radius_m * radius_m - across_m * across_m);
}

// In front of the body, or at its side: too near to be the echo of something uncertain.
bool IsBefore(double range_m, double radius_m, double unsure_m, const Sight& centre,
              double distance_m, double cone_rad, const Cone& cone) {
  constexpr double kUnsure_rad = 0.1;  // of its bearing
  const double slack_rad = kUnsure_rad + unsure_m / std::max(distance_m, radius_m);
  // The body's nearest point, if the cone held it, settles most without an angle.
  if (range_m < LeastRange(distance_m, radius_m, 0) - unsure_m) return true;
  if (IsWithin(cone_rad + slack_rad, centre, distance_m, cone)) return false;
  const double off_rad = OffAxis(centre.to_body, cone) - cone_rad - slack_rad;
  return range_m < LeastRange(distance_m, radius_m, off_rad) - unsure_m;
}

// The body shows from one tangent to the other; half the body more allows for uncertainty.
constexpr double kShows = 1.5;

// Nearly all that are too far off the axis for a body of this radius to be in the cone, without the
// root that their distance is: it lies between the greater of two legs and their sum.
bool IsFarOff(const Sight& centre, double radius_m, double cone_rad) {
  constexpr double kRounding_m = 1e-6;  // far more than the sums are off, and far less than a body
  const double along_m = Magnitude(centre.along_m);
  const double shows_m = kShows * radius_m + kRounding_m;
  const double least_m = std::max(along_m, centre.across_m);
  if (least_m <= shows_m) return false;
  const double wide_m = cone_rad * (along_m + centre.across_m) + shows_m;
  return centre.across_m > wide_m || (centre.along_m < 0 && wide_m < 1.5 * least_m);
}

// Whether an echo of that range is where the body's would be.
bool IsEchoOf(const Sight& centre, double radius_m, double range_m, double unsure_m,
              double cone_rad, const Cone& cone) {
  if (IsFarOff(centre, radius_m, cone_rad)) return false;
  const double distance_m = Norm(centre.to_body);
  if (Magnitude(range_m - (distance_m - radius_m)) > kSameBody_m) return false;
  const double half_width = distance_m > kShows * radius_m ? kShows * radius_m / distance_m : kPi;
  return IsWithin(cone_rad + half_width, centre, distance_m, cone) &&
         !IsBefore(range_m, radius_m, unsure_m, centre, distance_m, cone_rad, cone);
}

// Where a peer comes to stand if it brakes as soon as this vehicle does.
Vec2 WhereItStops(const CarriedPeer& peer, const OwnView& s) {
  const double on_m = ClosingSpeed(peer, s) > 0 ? StoppingDistanceOf(peer, s) : 0;
  return peer.position_world + on_m * peer.forward_world;
}

// Where the peer's body was to the own one when a sensor fired, both moving as now: their turning
// is slow against that.
Vec2 CentreBefore(double age_s, const CarriedPeer& peer, const OwnView& s) {
  const Vec2 centre_world = peer.position_world - age_s * VelocityOf(peer);
  return InBody(s, centre_world) + Vec2{age_s * s.speed_m_s, 0};
}

// The echo's range less what the vehicle has driven towards it since, as far as the reaction time
// does not allow for it already.
double RangeAhead(const SensorView& view, const OwnView& s) {
  const double since_s =
      EchoAge(view, s.tick, s.options.tick_period) - Seconds(s.options.sonar_refresh);
  return std::max(0.0, view.range_m - std::max(0.0, s.speed_m_s) * std::max(0.0, since_s));
}

// By how much the range of what a sensor hears shrinks with each metre driven, as its echoes show;
// 0 where they show nothing. Of imperfect ultrasonics, which hear a face along its normal: a turn
// on the spot changes that range by no more than the transducer moves.
double ShownSlant(const SensorView& view) {
  constexpr double kDriven_m_s = 0.05;  // slower, echoes show no slant
  const double driven_m_s = view.own.forward_m_s;
  if (driven_m_s < kDriven_m_s) return 0;
  return view.closing_m_s / driven_m_s;
}

}  // namespace

std::optional<double> FreeBeforeDisc(Vec2 centre_body, double sum_of_radii) {
  if (centre_body.x <= 0) return std::nullopt;
  const double half = (sum_of_radii + kPathMargin_m) * (sum_of_radii + kPathMargin_m) -
                      centre_body.y * centre_body.y;
  if (half <= 0) return std::nullopt;
  return std::max(0.0, centre_body.x - Sqrt(half));
}

std::optional<double> FreeBeforePoint(Vec2 point_body, double body_radius_m, double narrower_m) {
  const auto free_m = FreeBeforeDisc(point_body, body_radius_m - narrower_m);
  if (free_m && *free_m <= 0 && Magnitude(point_body.y) >= body_radius_m) return std::nullopt;
  return free_m;
}

void HearEchoes(const RangeView& ranges, Tick tick, const VehicleOptions& options,
                HeardEchoes* heard) {
  heard->count = 0;
  for (const std::size_t i : BitsOf(ranges.Echoes())) {
    heard->sensor[heard->count] = i;
    heard->age_s[heard->count] = EchoAge(ranges[i], tick, options.tick_period);
    ++heard->count;
  }
}

PeerEchoes EchoesOf(const CarriedPeer& peer, const OwnView& s) {
  const HeardEchoes& echoes = s.echoes;
  const double radius_m = peer.peer->beacon.body_radius_m;
  const Vec2 centre_now = InBody(s, peer.position_world);
  const double unsure_m = kNearer_m + kSigmas * peer.sigma_m;
  PeerEchoes of_peer;
  for (std::size_t k = 0; k < echoes.count; ++k) {
    const std::size_t sensor = echoes.sensor[k];
    const double age_s = echoes.age_s[k];
    const double range_m = s.ranges[sensor].range_m;
    const Cone& cone = s.cones.of[sensor];
    const Vec2 centre = age_s > 0 ? CentreBefore(age_s, peer, s) : centre_now;
    const Vec2 to_centre = centre - s.options.profile.sonar[sensor].position_body;
    const Sight sight = Seen(to_centre, cone);
    const double turned = age_s * Magnitude(s.turn_rad_s);
    const double cone_rad = s.options.profile.sonar_half_angle_rad + turned;
    const double by_noise_m = kNoiseSigmas * s.options.sonar_noise * range_m;
    if (!IsEchoOf(sight, radius_m, range_m, unsure_m + by_noise_m, cone_rad, cone)) continue;
    of_peer.sensors |= 1U << sensor;
    const double nearer_m = LeastRange(Norm(to_centre), radius_m, 0) - by_noise_m - range_m;
    if (nearer_m > kNearer_m) of_peer.nearer_m = std::max(of_peer.nearer_m, nearer_m);
  }
  return of_peer;
}

namespace {

// A direction to go in, and the ray in a cone that is nearest to it: unit vectors.
struct Bearing {
  Vec2 direction_body;
  Vec2 ray_body;
};

std::optional<double> FreeTowards(const Bearing& bearing, std::size_t sensor, const Situation& s) {
  const SensorView& view = s.own.ranges[sensor];
  const RobotModel& profile = s.own.options.profile;
  const Vec2 mount_body = profile.sonar[sensor].position_body;
  if (view.kind != Echo::kEcho || mount_body.x < 0) return std::nullopt;
  const bool explained = (s.near.explained >> sensor & 1U) != 0;
  // A fresh peer's claim says more than its echo: decision_rules.cc, KeepClear.
  if (explained && s.own.options.behaviour == Behaviour::kCooperative) return std::nullopt;
  const auto towards = [&bearing](Vec2 body) {
    return Vec2{Dot(bearing.direction_body, body), Cross(bearing.direction_body, body)};
  };
  for (const PeerView& peer : s.near.peers) {
    if (!explained || (peer.explains >> sensor & 1U) == 0) continue;
    return FreeBeforeDisc(towards(InBody(s.own, WhereItStops(peer, s.own))),
                          profile.body_radius_m + peer.peer->beacon.body_radius_m);
  }
  const Vec2 echo_body = mount_body + RangeAhead(view, s.own) * bearing.ray_body;
  return FreeBeforeDisc(towards(echo_body), profile.body_radius_m);
}

}  // namespace

std::optional<double> FreeAhead(std::size_t sensor, const Situation& s) {
  return FreeTowards({{1, 0}, s.own.cones.of[sensor].nearest_body}, sensor, s);
}

std::optional<double> FreeOnceTurned(std::size_t sensor, double turned_rad, const Situation& s) {
  const double half_rad = s.own.options.profile.sonar_half_angle_rad;
  const double bearing_rad = s.own.cones.of[sensor].bearing_rad;
  const double ray_rad = bearing_rad + std::clamp(turned_rad - bearing_rad, -half_rad, half_rad);
  const Bearing bearing{{Cos(turned_rad), Sin(turned_rad)}, {Cos(ray_rad), Sin(ray_rad)}};
  return FreeTowards(bearing, sensor, s);
}

std::optional<double> FreeAlongFace(std::size_t sensor, double turns_rad, const Situation& s) {
  const SensorView& view = s.own.ranges[sensor];
  const RobotModel& profile = s.own.options.profile;
  const Vec2 mount_body = profile.sonar[sensor].position_body;
  const Vec2 axis_body = s.own.cones.of[sensor].axis_body;
  const bool explained = (s.near.explained >> sensor & 1U) != 0;
  if (view.kind != Echo::kEcho || explained || mount_body.x < 0) return std::nullopt;
  const double slant = ShownSlant(view) + (axis_body.y > 0 ? turns_rad : -turns_rad);
  if (slant <= 0) return std::nullopt;
  const double since_s = EchoAge(view, s.own.tick, s.own.options.tick_period);
  const double range_m = view.range_m - std::max(0.0, view.closing_m_s) * since_s;
  const double apart_m = Dot(mount_body, axis_body) + range_m - profile.body_radius_m;
  return std::max(0.0, apart_m) / std::min(1.0, slant);
}

namespace {

// Exact ultrasonics hear the front of a building that the vehicle passes the end of, at the rim of
// a cone that looks to the side: the range shrinks so that along the path what is heard there stays
// where it is. Imperfect ones hear no face so far off its normal.
bool IsFrontAtRim(double along_m_s, double driving_m_s, double cosine,
                  const VehicleOptions& options) {
  // Shares of the own speed: a front that is not square to the path seems slower or faster.
  constexpr double kLeast = 0.6;
  constexpr double kMost = 1.6;
  if (HasImperfectSonar(options) || cosine <= 0 || cosine > kLooksAhead) return false;
  return along_m_s > kLeast * driving_m_s && along_m_s < kMost * driving_m_s;
}

}  // namespace

bool MovesByItself(std::size_t sensor, const OwnView& s) {
  const SensorView& view = s.ranges[sensor];
  const bool slow = s.options.sonar_refresh.count() > 0;
  if (view.streak < (slow ? kSlowMotionStreak : kMotionStreak)) return false;
  const RobotModel& profile = s.options.profile;
  // The closing speed is of the past, and so is the motion that explains it.
  const double driving = std::max(s.speed_m_s, view.own.forward_m_s);
  const double turning = std::max(Magnitude(s.turn_rad_s), view.own.turn_rad_s);
  const double by_noise = kNoiseSigmas * s.options.sonar_noise * view.range_m / kClosingTime_s;
  // The edge of a cone that looks ahead runs along a wall ahead faster than the vehicle drives; one
  // that looks to the side meets what it passes.
  const double cosine = s.cones.of[sensor].nearest_cosine;
  const double faster = cosine > kLooksAhead ? 1 / cosine : cosine;
  const double by_driving = std::max(0.0, driving * faster);
  const double by_turning = turning * (profile.body_radius_m + 0.3 * view.range_m);
  const double unexplained_m_s =
      view.closing_m_s - by_driving - by_turning - by_noise - kOwnMotion_m_s;
  return unexplained_m_s > 0 &&
         !IsFrontAtRim(view.closing_m_s * cosine, driving, cosine, s.options);
}

}  // namespace giveway

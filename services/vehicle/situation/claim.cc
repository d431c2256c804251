#include "services/vehicle/situation/claim.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/planted.h"

namespace giveway {
namespace {

constexpr double kFar_m = 1e6;
// From inside a claim: how much the way out may lead inwards at first. It comes nearer by no more
// than a thousandth of the distance, and a way square to it is not lost to rounding.
constexpr double kAlong = 0.045;
// Faster than it says it cruises nobody goes but by slip and rounding.
constexpr double kSpeedSlack = 1.1;
// The brain's own limit on turning while it drives (steering.cc) is half of what a body can do.
constexpr double kTurnWhileDriving_rad_s = 0.87;

Vec2 NearestOnAxis(const Claim& claim, Vec2 point) {
  const double along = Dot(point - claim.axis.from_world, claim.axis.direction_world);
  return claim.axis.from_world +
         std::clamp(along, 0.0, claim.length_m) * claim.axis.direction_world;
}

}  // namespace

double ClaimLength(const Beacon& beacon, double speed_m_s, double unknown_s, double reaction_s) {
  const double pace = Magnitude(speed_m_s);
  const double most = std::max(kSpeedSlack * beacon.cruise_m_s, pace);
  const double fastest = std::min(most, pace + beacon.acceleration_m_s2 * unknown_s);
  return (pace + fastest) / 2 * unknown_s +
         StoppingDistance(fastest, reaction_s, beacon.deceleration_m_s2);
}

bool IsClaimShort(const Beacon& beacon, double speed_m_s, double reaction_s, double length_m) {
  const double pace = Magnitude(speed_m_s);
  const double most = std::max(kSpeedSlack * beacon.cruise_m_s, pace);
  const double braking_m = length_m - most * (1 + reaction_s);
  return most * most < 2 * beacon.deceleration_m_s2 * braking_m;
}

Claim ClaimOf(const Beacon& beacon, const Course& course, double unknown_s, double reaction_s) {
  const double speed = course.speed_m_s;
  Claim claim;
  claim.axis = {beacon.world_from_body.position_world,
                speed < 0 ? -1.0 * course.forward_world : course.forward_world};
  claim.length_m =
      Has(Defect::kClaimWithoutWay) ? 0 : ClaimLength(beacon, speed, unknown_s, reaction_s);
  claim.radius_m = beacon.body_radius_m;
  // It may turn meanwhile: the far end swings. From standstill it may leave in any direction.
  const double swing = std::min(1.0, kTurnWhileDriving_rad_s * unknown_s);
  claim.radius_m += claim.length_m * (Magnitude(speed) < 0.02 ? 1.0 : swing);
  return claim;
}

double FreeBefore(const Claim& claim, const Path& path, double radius_m) {
  const double reach_m = radius_m + claim.radius_m;
  const Vec2 away = path.from_world - NearestOnAxis(claim, path.from_world);
  if (SquaredNorm(away) < reach_m * reach_m) {
    return Dot(away, path.direction_world) > -kAlong * Norm(away) ? kFar_m : 0;
  }
  const Path tail = {claim.axis.from_world + claim.length_m * claim.axis.direction_world,
                     -1.0 * claim.axis.direction_world};
  // A segment is what two half-lines against each other share.
  const Stretch one = StretchNear(path, claim.axis, reach_m);
  const Stretch other = StretchNear(path, tail, reach_m);
  const double begin = std::max(one.begin_m, other.begin_m);
  const double end = std::min(one.end_m, other.end_m);
  return begin > end || end <= 0 ? kFar_m : std::max(0.0, begin);
}

}  // namespace giveway

#include "services/vehicle/situation/claim.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/injected_mutants.h"

namespace giveway {
namespace {

// From inside a claim: how far the exit path may lead inwards at first. It comes nearer by no more
// than a thousandth of the distance, and a path square to it is not lost to rounding.
constexpr double kAlong = 0.045;
// The same for the body itself, past which an exit path may lead: it comes nearer by a thirtieth.
constexpr double kToBody = 0.25;
// Slower than this it counts as one that may set off anywhere.
constexpr double kStands_m_s = 0.02;

Vec2 NearestOnAxis(const Claim& claim, Vec2 point) {
  const double along = Dot(point - claim.axis.from_world, claim.axis.direction_world);
  return claim.axis.from_world +
         std::clamp(along, 0.0, claim.length_m) * claim.axis.direction_world;
}

// True if the path, starting at `offset` from something, leads no nearer to it, or hardly: the
// cosine of the angle to it is below `inwards`.
bool LeadsAway(Vec2 offset, const Path& path, double inwards) {
  return Dot(offset, path.direction_world) > -inwards * Norm(offset);
}

// How fast it drives, or may at once: of one whose inner rim rolls back the centre speeds up as
// soon as that rim brakes.
double PaceOf(const Course& course, const DriveGeometry& drive) {
  const double speed_m_s = Magnitude(course.speed_m_s);
  const double outer_m_s = speed_m_s + Magnitude(course.turn_rad_s) * drive.axle_m / 2;
  return std::max(speed_m_s, outer_m_s / 2);
}

// How fast the sender of `beacon` may drive after unknown_s.
double MostSpeed(const Beacon& beacon, double pace_m_s, double unknown_s) {
  const double most = std::max(kCruiseSlack * beacon.cruise_m_s, pace_m_s);
  return std::min(most, pace_m_s + beacon.acceleration_m_s2 * unknown_s);
}

// How fast the sender of `beacon` may turn after unknown_s: one rim speeds up while the other
// brakes.
double MostTurn(const Beacon& beacon, double turn_rad_s, double unknown_s) {
  const double change_rad_s =
      (beacon.acceleration_m_s2 + beacon.deceleration_m_s2) / beacon.drive.axle_m * unknown_s;
  return std::min(kTurnWhileDriving_rad_s, Magnitude(turn_rad_s) + change_rad_s);
}

// From standstill it may leave in any direction, and forward from a reverse that it can stop.
bool MayLeaveAnywhere(const Beacon& beacon, double speed_m_s, double unknown_s) {
  if (Magnitude(speed_m_s) < kStands_m_s) return true;
  return speed_m_s < 0 && -speed_m_s < beacon.deceleration_m_s2 * unknown_s;
}

// How fast the sender of `beacon` may turn once its centre moves at speed_m_s, unknown_s after it
// stood: its outer rim does no more than speed up.
double TurnSettingOff(const Beacon& beacon, const Course& course, double speed_m_s,
                      double unknown_s) {
  const double outer_m_s = Magnitude(course.speed_m_s) +
                           Magnitude(course.turn_rad_s) * beacon.drive.axle_m / 2 +
                           beacon.acceleration_m_s2 * unknown_s;
  return std::max(0.0, outer_m_s - speed_m_s) * 2 / beacon.drive.axle_m;
}

}  // namespace

double SwingOf(double turn_rad_s, double steady_s, double speed_m_s, double deceleration_m_s2,
               const PoseCovariance& covariance) {
  const double braking_s = speed_m_s / deceleration_m_s2;
  const double off_rad = kSigmas * SigmaHeading(covariance);
  return std::min(1.0, off_rad + Magnitude(turn_rad_s) * (steady_s + braking_s / 3));
}

double TurnRollsOn(double turn_rad_s, double axle_m, double deceleration_m_s2) {
  const double beside_m_s = turn_rad_s * axle_m / 2;
  return beside_m_s * beside_m_s / (2 * deceleration_m_s2);
}

double ClaimLength(const Beacon& beacon, double pace_m_s, double unknown_s, double reaction_s) {
  const double fastest = MostSpeed(beacon, pace_m_s, unknown_s);
  const double gained = fastest - pace_m_s;
  return fastest * unknown_s - gained * gained / (2 * beacon.acceleration_m_s2) +
         StoppingDistance(fastest, reaction_s, beacon.deceleration_m_s2);
}

bool IsClaimShort(const Beacon& beacon, double speed_m_s, double lasts_s, double reaction_s,
                  double length_m) {
  const double pace = Magnitude(speed_m_s);
  const double most = std::max(kCruiseSlack * beacon.cruise_m_s, pace);
  const double rolls_on_m =
      TurnRollsOn(kTurnWhileDriving_rad_s, beacon.drive.axle_m, beacon.deceleration_m_s2);
  const double braking_m = length_m - most * (lasts_s + reaction_s) - rolls_on_m;
  return most * most < 2 * beacon.deceleration_m_s2 * braking_m;
}

Claim ClaimOf(const Beacon& beacon, const Course& course, double unknown_s, double reaction_s) {
  const double speed = course.speed_m_s;
  const double pace_m_s = PaceOf(course, beacon.drive);
  Claim claim;
  claim.axis = {beacon.world_from_body.position_world,
                speed < 0 ? -1.0 * course.forward_world : course.forward_world};
  claim.length_m = MutantActive(Mutant::kClaimWithoutWay)
                       ? 0
                       : ClaimLength(beacon, pace_m_s, unknown_s, reaction_s);
  claim.radius_m = beacon.body_radius_m;
  const double fastest_m_s = MostSpeed(beacon, pace_m_s, unknown_s);
  const double turn_rad_s = MostTurn(beacon, course.turn_rad_s, unknown_s);
  const auto rolls_on_m = [&beacon](double turn) {
    return TurnRollsOn(turn, beacon.drive.axle_m, beacon.deceleration_m_s2);
  };
  if (MayLeaveAnywhere(beacon, speed, unknown_s)) {
    const double setting_off = TurnSettingOff(beacon, course, fastest_m_s, unknown_s);
    claim.radius_m += claim.length_m + rolls_on_m(std::min(turn_rad_s, setting_off));
    claim.length_m = 0;
    return claim;
  }
  claim.length_m += rolls_on_m(turn_rad_s);
  // It may turn: the far end swings.
  const double outer_m_s = fastest_m_s + Magnitude(turn_rad_s) * beacon.drive.axle_m / 2;
  claim.radius_m += claim.length_m * SwingOf(turn_rad_s, unknown_s + reaction_s, outer_m_s,
                                             beacon.deceleration_m_s2, beacon.covariance);
  return claim;
}

double FreeBefore(const Claim& claim, const Path& path, double radius_m) {
  const double reach_m = radius_m + claim.radius_m;
  const Vec2 away = path.from_world - NearestOnAxis(claim, path.from_world);
  if (SquaredNorm(away) < reach_m * reach_m) {
    const Vec2 from_body = path.from_world - claim.axis.from_world;
    const bool leads_out = LeadsAway(away, path, kAlong) && LeadsAway(from_body, path, kToBody);
    return leads_out ? kFar_m : 0;
  }
  const Stretch near = StretchNearSegment(path, claim.axis, claim.length_m, reach_m);
  return near.end_m <= 0 ? kFar_m : std::max(0.0, near.begin_m);
}

}  // namespace giveway

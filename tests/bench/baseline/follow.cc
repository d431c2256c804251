#include "tests/bench/baseline/follow.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway::bench {
namespace {

// The lattice of speeds rounds nothing, but sums of many ticks do.
constexpr double kNoise_rad = 1e-9;
constexpr double kAhead_s = 0.1;         // wheels need about this to take up a new bend
constexpr double kBackOnPlan_per_s = 1;  // share of what it is behind or before
constexpr double kAcross_per_m2 = 6;
constexpr double kHeading_per_m = 5;
constexpr double kTurnsOnTheSpot_rad = 0.02;

// On the spot: as fast as it can still be stopped from at the goal.
double TurnOnTheSpot(const RobotModel& profile, double left_rad) {
  const double off_rad = std::max(left_rad, -left_rad);
  if (off_rad < kNoise_rad) return 0;
  constexpr double kGain_per_s = 6;
  const double slowing_rad_s2 = 0.8 * profile.deceleration_m_s2 / (profile.drive.axle_m / 2);
  const double rate = std::min(kGain_per_s * off_rad, Sqrt(2 * slowing_rad_s2 * off_rad));
  return left_rad > 0 ? rate : -rate;
}

}  // namespace

WheelSpeeds FollowPath(const RobotModel& profile, const ArcPath& path, const Planned& planned,
                       const Pose& world_from_body) {
  const Pose wanted = path.PoseAt(planned.driven_m);
  const Vec2 off = ToBody(wanted, world_from_body.position_world);
  const double heading_off = WrapAngle(world_from_body.heading_rad - wanted.heading_rad);
  if (planned.speed_m_s <= 0) {
    const bool turned_away =
        heading_off > kTurnsOnTheSpot_rad || heading_off < -kTurnsOnTheSpot_rad;
    if (planned.driven_m > 0 || !turned_away) return {};
    return WheelsFromTwist(profile.drive, {0, TurnOnTheSpot(profile, -heading_off)});
  }
  const double speed = std::max(0.0, planned.speed_m_s - kBackOnPlan_per_s * off.x);
  const double bend = path.BendAt(planned.driven_m + kAhead_s * planned.speed_m_s) -
                      kAcross_per_m2 * off.y - kHeading_per_m * heading_off;
  return WheelsFromTwist(profile.drive, {speed, bend * speed});
}

double SecondsToTurn(const RobotModel& profile, double angle_rad) {
  const double angle = std::max(angle_rad, -angle_rad);
  if (angle < kTurnsOnTheSpot_rad) return 0;
  constexpr double kSettle_s = 0.8;
  const double rim_m = angle * profile.drive.axle_m / 2;
  return Sqrt(2 * rim_m * (1 / profile.acceleration_m_s2 + 1 / (0.8 * profile.deceleration_m_s2))) +
         kSettle_s;
}

}  // namespace giveway::bench

#include "sim_world/start_place.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/types/time.h"
#include "sim_world/geometry/approach.h"

namespace giveway::sim {
namespace {

double RimSpeedOf(const Body& body) {
  const auto [left_rad_s, right_rad_s] = body.wheels;
  return body.profile.drive.wheel_radius_m *
         std::max(Magnitude(left_rad_s), Magnitude(right_rad_s));
}

// How far the faster wheel still rolls: v t + a t^2 / 2, then (v + a t)^2 / 2 d.
double StoppingDistance(const RobotModel& profile, double rim_m_s, double unaware_s) {
  const double gained_m_s = profile.acceleration_m_s2 * unaware_s;
  const double fastest_m_s = rim_m_s + gained_m_s;
  return (rim_m_s + gained_m_s / 2) * unaware_s +
         fastest_m_s * fastest_m_s / (2 * profile.deceleration_m_s2);
}

}  // namespace

bool HitsWhileStopping(const Body& body, double unaware_s, const Motion& newcomer) {
  Motion motion = StandingAt(body.profile, body.world_from_body);
  const double apart_m = GapAt(motion, newcomer, 0);
  if (apart_m <= kTouch_m) return true;
  const double rim_m_s = RimSpeedOf(body);
  if (rim_m_s == 0) return false;
  // At the present speeds of its wheels for longer: as far, on the same arc.
  unaware_s += Seconds(body.sonar_refresh);
  motion.twist = TwistFromWheels(body.profile.drive, body.wheels);
  motion.stop_s = StoppingDistance(body.profile, rim_m_s, unaware_s) / rim_m_s;
  const double shell_m_s =
      Magnitude(motion.twist.forward_m_s) + motion.radius_m * Magnitude(motion.twist.turn_rad_s);
  if (apart_m > kTouch_m + shell_m_s * motion.stop_s) return false;
  return FirstContact(motion, newcomer, 0, motion.stop_s).has_value();
}

bool HitsOnItsCourse(const MovingObstacle& obstacle, double leaving_s, double dt_s,
                     const Motion& newcomer) {
  const double apart_m = GapAt(obstacle.Plan(false, dt_s), newcomer, 0);
  if (apart_m <= kTouch_m) return true;
  if (apart_m > obstacle.Speed() * (leaving_s + dt_s)) return false;
  MovingObstacle ahead = obstacle;
  for (double t_s = 0; t_s < leaving_s; t_s += dt_s) {
    const Motion motion = ahead.Plan(true, dt_s);
    if (FirstContact(motion, newcomer, 0, dt_s)) return true;
    ahead.Settle(motion, true, dt_s);
  }
  return false;
}

double LeavingSeconds(const RobotModel& profile) {
  const double length_m = 2 * StandingAt(profile, {}).radius_m;
  return std::max(Sqrt(2 * length_m / profile.acceleration_m_s2), length_m / profile.max_speed_m_s);
}

}  // namespace giveway::sim

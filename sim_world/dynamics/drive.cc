#include "sim_world/dynamics/drive.h"

#include <algorithm>
#include <cmath>

namespace giveway::sim {
namespace {

struct WheelRates {
  double speed_up_rad_s2;
  double slow_down_rad_s2;
};

double Approach(double from, double to, double most) {
  const double difference = to - from;
  return std::abs(difference) <= most ? to : from + std::copysign(most, difference);
}

double MoveWheel(double current, double target, const WheelRates& rates, double dt_s) {
  const bool reverses = current * target < 0;
  const bool shrinks = reverses || std::abs(target) < std::abs(current);
  if (!shrinks) return Approach(current, target, rates.speed_up_rad_s2 * dt_s);
  const double slowest = reverses ? 0 : target;
  const double slowed = Approach(current, slowest, rates.slow_down_rad_s2 * dt_s);
  if (slowed != slowest || !reverses) return slowed;
  const double left_s = std::max(0.0, dt_s - std::abs(current) / rates.slow_down_rad_s2);
  return Approach(0, target, rates.speed_up_rad_s2 * left_s);
}

}  // namespace

WheelSpeeds WithinCaps(const RobotModel& profile, WheelSpeeds wheels) {
  const Twist asked = TwistFromWheels(profile.drive, wheels);
  const Twist capped = {
      std::clamp(asked.forward_m_s, -profile.max_speed_m_s, profile.max_speed_m_s),
      std::clamp(asked.turn_rad_s, -profile.max_turn_rad_s, profile.max_turn_rad_s)};
  // A conversion to a twist and back would change the last bits of speeds that need no cap.
  if (capped.forward_m_s == asked.forward_m_s && capped.turn_rad_s == asked.turn_rad_s) {
    return wheels;
  }
  return WheelsFromTwist(profile.drive, capped);
}

WheelSpeeds MoveWheels(const RobotModel& profile, WheelSpeeds current, WheelSpeeds target,
                       double dt_s) {
  const WheelRates rates = {profile.acceleration_m_s2 / profile.drive.wheel_radius_m,
                            profile.deceleration_m_s2 / profile.drive.wheel_radius_m};
  const WheelSpeeds goal = WithinCaps(profile, target);
  const WheelSpeeds moved = {MoveWheel(current.left_rad_s, goal.left_rad_s, rates, dt_s),
                             MoveWheel(current.right_rad_s, goal.right_rad_s, rates, dt_s)};
  return WithinCaps(profile, moved);
}

Rolled Roll(const RobotModel& profile, WheelSpeeds wheels, Random random) {
  const WheelSpeeds rolls =
      profile.wheel_error.Any() ? AsNominal(profile.drive, profile.wheel_error, wheels) : wheels;
  if (profile.wheel_slip == 0 && profile.encoder_noise == 0) {
    return {profile.wheel_error.Any() ? WithinCaps(profile, rolls) : wheels, wheels};
  }
  const auto disturbed = [&](WheelSpeeds speeds, double share) {
    const double left = 1 + random.Gaussian(share);
    const double right = 1 + random.Gaussian(share);
    return WheelSpeeds{left * speeds.left_rad_s, right * speeds.right_rad_s};
  };
  const WheelSpeeds ground = disturbed(rolls, profile.wheel_slip);
  return {WithinCaps(profile, ground), disturbed(wheels, profile.encoder_noise)};
}

}  // namespace giveway::sim

#include "tests/fuzz/outputs.h"

#include <cmath>

#include "services/types/check.h"
#include "services/vehicle/estimation/beacon_check.h"

namespace giveway::fuzz {
namespace {

constexpr double kSlack = 1e-9;  // relative: rounding of a conversion to a twist and back

void CheckCaps(const WheelSpeeds& target, const RobotModel& profile) {
  const Twist twist = TwistFromWheels(profile.drive, target);
  GIVEWAY_CHECK(std::abs(twist.forward_m_s) <= profile.max_speed_m_s * (1 + kSlack),
                twist.forward_m_s, profile.max_speed_m_s);
  GIVEWAY_CHECK(std::abs(twist.turn_rad_s) <= profile.max_turn_rad_s * (1 + kSlack),
                twist.turn_rad_s, profile.max_turn_rad_s);
}

// The avoiding behaviours ask for what their weights add up to; the world caps it.
void CheckWeights(const WheelSpeeds& target, const BraitenbergWeights& weights) {
  double left = weights.base_rad_s;
  double right = weights.base_rad_s;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    left += std::abs(weights.left[i]);
    right += std::abs(weights.right[i]);
  }
  GIVEWAY_CHECK(std::abs(target.left_rad_s) <= left * (1 + kSlack), target.left_rad_s, left);
  GIVEWAY_CHECK(std::abs(target.right_rad_s) <= right * (1 + kSlack), target.right_rad_s, right);
}

}  // namespace

void CheckOutputs(const Outputs& outputs, const VehicleOptions& options) {
  const WheelSpeeds& target = outputs.command.target;
  GIVEWAY_CHECK(std::isfinite(target.left_rad_s) && std::isfinite(target.right_rad_s),
                target.left_rad_s, target.right_rad_s);
  GIVEWAY_CHECK(IsFinite(outputs.beacon), Number(options.id));
  if (outputs.command.decision.rule == Rule::kAvoid ||
      options.behaviour == Behaviour::kLectureAvoid ||
      options.behaviour == Behaviour::kStockAvoid) {
    CheckWeights(target, options.braitenberg);
  } else {
    CheckCaps(target, options.profile);
  }
}

}  // namespace giveway::fuzz

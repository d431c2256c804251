#include "services/types/handover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/types/math/math.h"

namespace giveway {
namespace {

// Rounding may leave a little more than the square root of the product of the two variances.
bool CanBeCovariance(double covariance, double variance_a, double variance_b) {
  constexpr double kRounded = 1e-9;
  return covariance * covariance <= variance_a * variance_b * (1 + kRounded) + kRounded * kRounded;
}

}  // namespace

bool IsSound(const Handover& handover) {
  const Pose& pose = handover.world_from_body;
  const PoseCovariance& c = handover.covariance;
  const std::array numbers = {handover.counted.left_rad,
                              handover.counted.right_rad,
                              pose.position_world.x,
                              pose.position_world.y,
                              pose.heading_rad,
                              c.xx_m2,
                              c.xy_m2,
                              c.yy_m2,
                              c.xh_m_rad,
                              c.yh_m_rad,
                              c.hh_rad2};
  return handover.epoch != kNoEpoch && handover.tick != kNoTick &&
         std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); }) &&
         Magnitude(pose.heading_rad) <= kPi && c.xx_m2 >= 0 && c.yy_m2 >= 0 && c.hh_rad2 >= 0 &&
         CanBeCovariance(c.xy_m2, c.xx_m2, c.yy_m2) &&
         CanBeCovariance(c.xh_m_rad, c.xx_m2, c.hh_rad2) &&
         CanBeCovariance(c.yh_m_rad, c.yy_m2, c.hh_rad2);
}

// A body that was put on its place after the handover has counted nothing yet. So has one that
// never moved: then the answer is as good.
bool IsOfTheSameBody(const Handover& handover, const RosterEntry& entry) {
  return entry.accepted && entry.epoch == handover.epoch &&
         (entry.tick <= handover.tick || !(entry.counted == WheelAngles{}));
}

}  // namespace giveway

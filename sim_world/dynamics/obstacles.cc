#include "sim_world/dynamics/obstacles.h"

#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"

namespace giveway::sim {

Course::Course(const Obstacle& obstacle) {
  corners_world_.push_back(obstacle.start_world.position_world);
  const auto& waypoints = obstacle.waypoints_world;
  corners_world_.insert(corners_world_.end(), waypoints.begin(), waypoints.end());
  if (obstacle.loop) {
    corners_world_.push_back(corners_world_.front());
  } else {
    for (std::size_t i = corners_world_.size() - 1; i-- > 0;) {
      corners_world_.push_back(corners_world_[i]);
    }
  }
  until_m_.push_back(0);
  for (std::size_t i = 1; i < corners_world_.size(); ++i) {
    until_m_.push_back(until_m_.back() + Norm(corners_world_[i] - corners_world_[i - 1]));
  }
  period_m_ = until_m_.back();
}

double Course::Folded(double progress_m) const {
  if (IsEmpty()) return 0;
  return progress_m - std::floor(progress_m / period_m_) * period_m_;
}

Vec2 Course::At(double progress_m) const {
  if (IsEmpty()) return corners_world_.front();
  const double along_m = Folded(progress_m);
  const auto next = std::upper_bound(until_m_.begin(), until_m_.end(), along_m);
  if (next == until_m_.end()) return corners_world_.back();
  const auto i = static_cast<std::size_t>(next - until_m_.begin());
  const double share = (along_m - until_m_[i - 1]) / (until_m_[i] - until_m_[i - 1]);
  return corners_world_[i - 1] + share * (corners_world_[i] - corners_world_[i - 1]);
}

MovingObstacle::MovingObstacle(const Obstacle& obstacle)
    : course_(obstacle),
      heading_rad_(obstacle.start_world.heading_rad),
      radius_m_(obstacle.shape == BodyShape::kBox ? Norm(obstacle.box_half_m) : obstacle.radius_m),
      box_half_m_(obstacle.shape == BodyShape::kBox ? obstacle.box_half_m : Vec2{}),
      speed_m_s_(obstacle.speed_m_s),
      state_{obstacle.start_world.position_world, 0} {}

Motion MovingObstacle::Plan(bool moving, double dt_s) const {
  Motion motion{.start_world = {state_.position_world, heading_rad_},
                .stop_s = dt_s,
                .radius_m = radius_m_,
                .box_half_m = box_half_m_};
  if (!moving || !EverMoves()) return motion;
  const double reach_m = speed_m_s_ * dt_s;
  const Vec2 displacement = course_.At(state_.progress_m + reach_m) - state_.position_world;
  const double distance_m = Norm(displacement);
  motion.slide_world = (distance_m > reach_m ? reach_m / distance_m : 1.0) / dt_s * displacement;
  return motion;
}

// A tick in which it turns may end where it started: it stands in that one, and its progress counts
// all the same.
void MovingObstacle::Settle(const Motion& motion, bool moving, double dt_s) {
  if (!moving || !EverMoves()) return;
  state_.position_world = PositionAt(motion, dt_s);
  state_.progress_m = course_.Folded(state_.progress_m + speed_m_s_ * motion.stop_s);
}

}  // namespace giveway::sim

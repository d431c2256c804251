// A body that is not a vehicle: it stands, or follows its waypoints at constant speed. An
// obstruction stops it; it continues from there once clear.
#pragma once

#include <vector>

#include "services/types/scenario.h"
#include "sim_world/geometry/motion.h"

namespace giveway::sim {

// The path from a start over waypoints, repeated as a loop or back and forth.
class Course {
 public:
  explicit Course(const Obstacle& obstacle);

  bool IsEmpty() const { return period_m_ <= 0; }
  // The position that many metres along it.
  Vec2 At(double progress_m) const;
  // The same position as a distance of less than one round.
  double Folded(double progress_m) const;

 private:
  std::vector<Vec2> corners_world_;
  std::vector<double> until_m_;  // from the start to each corner, along the course
  double period_m_ = 0;          // after which it repeats
};

// The variable state of an obstacle.
struct ObstacleState {
  Vec2 position_world;
  double progress_m = 0;  // how far along its course it heads; after a stop in a bend it may be
                          // some centimetres off it
};

class MovingObstacle {
 public:
  explicit MovingObstacle(const Obstacle& obstacle);

  // Its motion in a tick of dt_s: straight to where its course leads, cutting bends by less than
  // one tick's travel. Standing unless `moving`.
  Motion Plan(bool moving, double dt_s) const;
  // Applies the outcome of the motion that was planned with the same `moving`.
  void Settle(const Motion& motion, bool moving, double dt_s);

  const ObstacleState& State() const { return state_; }
  void Restore(const ObstacleState& state) { state_ = state; }
  bool EverMoves() const { return speed_m_s_ > 0 && !course_.IsEmpty(); }
  double Speed() const { return EverMoves() ? speed_m_s_ : 0; }  // m/s

 private:
  Course course_;
  double heading_rad_;
  double radius_m_;
  Vec2 box_half_m_;
  double speed_m_s_;
  ObstacleState state_;
};

}  // namespace giveway::sim

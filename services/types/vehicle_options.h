// Everything that makes one vehicle drive as it does. Set once at start; never changed by Step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/types/decision.h"
#include "services/types/ids.h"
#include "services/types/math/distance.h"
#include "services/types/one_lane.h"
#include "services/types/robot_model.h"
#include "services/types/task_progress.h"
#include "services/types/time.h"

namespace giveway {

// Where a vehicle wants to be. Without a goal it drives straight on and never arrives.
struct Goal {
  bool set = false;
  Vec2 at_world;          // m
  double radius_m = 0.1;  // arrived when it stands with the axle centre this near
};

inline constexpr std::size_t kMaxWaypoints = 16;

// Points passed in turn before the goal, each within radius_m; a loop starts again after the last
// and never comes to the goal.
struct Route {
  std::array<Vec2, kMaxWaypoints> waypoints_world{};
  std::uint32_t count = 0;
  bool loop = false;
  double radius_m = 0.3;
};

// A waypoint that the route does not have, as one of another scenario's, is as good as none: the
// route starts at its first.
constexpr TaskProgress OnRoute(const Route& route, TaskProgress task) {
  const bool has = task.waypoint < route.count || (task.waypoint == route.count && !route.loop);
  if (!has) task.waypoint = 0;
  return task;
}

// Wheel speed = v0 + sum of weight * activation, activation 1 at the near gate and 0 at the far
// one.
struct BraitenbergWeights {
  double base_rad_s = 2.0;
  double near_gate_m = 0.2;
  double far_gate_m = 1.0;
  std::array<double, kSensorCount> left{};  // rad/s per activation
  std::array<double, kSensorCount> right{};

  bool operator==(const BraitenbergWeights&) const = default;
};

// Vehicle 2a as the lecture prints it: excites the wheel of the same side. Far gate 1.0 m.
BraitenbergWeights LectureWeights();
// The stock simulator script: vehicle 3b with braking. Far gate 0.5 m.
BraitenbergWeights StockWeights();
// What a vehicle of the behaviour drives with unless its scenario writes weights: the stock
// script's for kStockAvoid, the lecture's for every other.
BraitenbergWeights WeightsOf(Behaviour behaviour);

struct VehicleOptions {
  VehicleId id = kNoVehicle;
  Behaviour behaviour = Behaviour::kCooperative;
  RobotModel profile;
  double cruise_m_s = 0.3;  // 0 < cruise <= profile.max_speed_m_s
  Goal goal;
  Route route;
  Pose start_world;                // given by the world's roster
  BraitenbergWeights braitenberg;  // of the avoiding behaviours
  Nanoseconds tick_period{50'000'000};
  double gate_enter_m = 1.0;  // the lecture's critical distance, shell to shell
  double gate_exit_m = 1.2;   // a latched encounter is over beyond it
  // How far a peer is at the gates, by GateDistance; of kCooperative and kLectureYield.
  DistanceMetric distance_metric = DistanceMetric::kEuclidean;
  double emission_radius_m = 5.0;             // beacons stated from further away are not heard
  Nanoseconds beacon_age_limit{200'000'000};  // receiver's clock; older is not fresh
  Nanoseconds ranges_age_limit{150'000'000};  // a scan older than this: halt
  // How long a transducer takes from one firing to the next one's result: 0 where all fire every
  // tick. A reading may be older than a scan by this much.
  Nanoseconds sonar_refresh{0};
  // Standard deviation of a reading, share of its range; 0: readings are exact and miss nothing.
  double sonar_noise = 0;
  Nanoseconds ageing_limit{20'000'000'000};  // waiting longer moves a vehicle up the order
  std::vector<OneLane> one_lanes;  // of the map that all vehicles share; at most kMaxOneLanes
  // How long after its last command the body of a vehicle that fell silent is still there.
  Nanoseconds silent_body_stays{6'000'000'000};
};

// False of a loop too, which never comes to the goal it may have.
inline bool HasGoal(const VehicleOptions& options) {
  return options.goal.set && !(options.route.loop && options.route.count > 0);
}

}  // namespace giveway

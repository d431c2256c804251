// Realistic fleets: gives each vehicle of a generator another robot model, another sensor tier,
// wheels that slip or are unequal, encoders that miscount, and a sensor of its position. Has its
// own random stream, so that without it every seed keeps its meaning. What is physically
// impossible, by the checks that refuse it in a scenario file, is drawn again.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/types/math/random.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

// The operator's choice.
struct FleetChoice {
  bool mixed_robots = false;     // else Pioneers as the place has them
  std::vector<SonarTier> tiers;  // a seed draws one; empty: the place's own
  double least_slip = 0;         // of wheel slip and of encoder noise: share of a wheel's speed
  double most_slip = 0;
  double least_wheel_error = 0;  // of diameter and axle, either sign: share
  double most_wheel_error = 0;
  PoseFixModel pose_fix;        // not fitted: the place's own
  bool draws_pose_fix = false;  // else that one: each seed draws a sensor for all
  // Of the seeds so many have the wheel errors and the sensor; the others have neither.
  double pose_keeping_share = 1;
  std::optional<double> pose_limit_m;  // absent: the usual one with fixes or wheel errors
};

class FleetDraw {
 public:
  // Bodies up to most_radius_m. `delay_s` is the longest transit time of a beacon.
  FleetDraw(const FleetChoice& choice, double most_radius_m, double delay_s, Random dice);

  // The place's ultrasonics: the drawn tier, or unchanged.
  SonarModel Sonar(SonarModel sonar) const;
  // Turns a vehicle with its id and behaviour into the next vehicle of the fleet.
  void Take(VehicleOptions* options);
  // The number of draws so far that no brakes could have made safe.
  std::uint32_t Refused() const { return refused_; }

 private:
  bool ComesOut(const VehicleOptions& options) const;
  void DrawPoseSensor();
  void DrawPoseKeeping(RobotModel* profile);
  VehicleOptions Draw(const VehicleOptions& plain);

  FleetChoice choice_;
  double most_radius_m_;
  double delay_s_;
  Random dice_;
  Random pose_dice_;  // separate, so that robots do not depend on it
  std::optional<SonarTier> tier_;
  std::vector<VehicleOptions> taken_;
  std::uint32_t refused_ = 0;
};

}  // namespace giveway::fleetctl

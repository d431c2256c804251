// Keeps a believed pose true where something is known to make it wrong or to put it right: an
// extended Kalman filter of pose and of the wheels' systematic errors around the dead reckoning of
// odometry.h. Fixes are weighed, those that do not fit are gated, and what they say instead is
// doubted until they agree with each other. Says how unsure the pose is and whether the vehicle is
// lost. Does nothing, and costs nothing, without a sensor of fixes, wheel errors or a limit. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "services/types/pose_sensing.h"
#include "services/types/robot_model.h"
#include "services/types/state_hash.h"
#include "services/vehicle/estimation/odometry.h"
#include "services/vehicle/estimation/pose_filter.h"

namespace giveway {

// Where it took itself to be at a tick: fixes speak of the past.
struct PastPose {
  Tick tick = kNoTick;
  Vec2 position_world;
  double heading_rad = 0;
};
// Of the latest ticks: 0.8 s at 50 ms; an older fix is not used.
inline constexpr std::size_t kPastPoses = 16;

// What fixes say that do not fit, of which one after the other says about the same.
struct Disagreement {
  Vec2 off_world;      // from where it takes itself to be to where they say
  double off_rad = 0;  // the same of its heading; 0 where they say nothing of it
  std::uint32_t fixes = 0;
};

struct PoseKeeping {
  Calibration calibration;
  std::array<PastPose, kPastPoses> past{};  // at tick % kPastPoses
  PoseFix waiting;                          // of this tick or a later one; no tick: none
  Tick agreed = kNoTick;                    // of the last fix that was believed, or the first tick
  Disagreement disagreement;
  std::uint32_t fixes_used = 0;     // since the process started
  std::uint32_t fixes_refused = 0;  // out of date, or not believed
  bool lost = false;
  double wrong_share = 0;  // of recent fixes, those that were wrong; newer ones weigh more
};

// True of a vehicle for which all this is done.
bool KeepsPose(const RobotModel& profile);

// On entering a world, where it is given its start pose; counts continue.
void Begin(const RobotModel& profile, PoseKeeping* keeping);

// What the wheels did from the last tick to `tick`, dt_s later.
struct Rolling {
  WheelSpeeds wheels;  // as measured
  double dt_s = 0;
  double wheel_error = 0;  // drawn again each tick, as a share of a wheel's speed
  double guessed_m = 0;    // see Odometry::Roll
  Tick tick = kNoTick;
};

// Rolls odometry on by wheels as they are known to err. Returns what is not known of this step
// alone, as Odometry::Roll does; systematic errors of wheels are not in it.
PoseCovariance Roll(const RobotModel& profile, const Rolling& rolling, Odometry* odometry,
                    PoseKeeping* keeping);

// The vehicle that takes a fix.
struct FixTaker {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;  // of the odometry's pose
  double tick_s = 0;
};

// A fix is weighed from the tick after its own on, whenever it comes, so that it makes no
// difference whether it is faster than the scan of its tick. At most kPastPoses - 1 ticks late.
void Take(const PoseFix& fix, const RobotModel& profile, const FixTaker& taker, Odometry* odometry,
          PoseKeeping* keeping);
// The fix that waited for its tick to pass, if there is one.
void TakeWaiting(const RobotModel& profile, const FixTaker& taker, Odometry* odometry,
                 PoseKeeping* keeping);

// What others may rely on: the filter's covariance, and what fixes say that do not fit.
PoseCovariance PromisedCovariance(const Odometry& odometry, const PoseKeeping& keeping);

// Takes in how unsure the pose is now. Returns the share of its cruise speed that the vehicle may
// drive: less from well below the limit on, 0 while it is lost.
double JudgeCertainty(const RobotModel& profile, const PoseCovariance& promised,
                      PoseKeeping* keeping);

void AddTo(const PoseKeeping& keeping, StateHash* hash);

}  // namespace giveway

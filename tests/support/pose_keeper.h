// A vehicle that keeps its pose by wheels and fixes, and whose true pose is known. No brain, no
// world.
#pragma once

#include <array>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "services/vehicle/estimation/pose_keeping.h"

namespace giveway::test {

inline constexpr double kDt_s = 0.05;
inline constexpr double kSigma_m = 0.05;
inline constexpr WorldEpoch kKeepersEpoch{7};
inline constexpr VehicleId kOwn{1};

inline RobotModel Fitted(double wheel_slip = 0) {
  RobotModel profile = PioneerP3dx();
  profile.pose_fix = {.every_s = 1, .sigma_m = kSigma_m};
  profile.wheel_slip = wheel_slip;
  profile.pose_limit_m = kUsualPoseLimit_m;
  return profile;
}

// A vehicle whose true pose is known, with encoders that may deviate.
class Keeper {
 public:
  explicit Keeper(const RobotModel& profile, std::uint64_t seed = 1)
      : profile_(profile), random_(seed) {
    Begin(profile_, &keeping);
  }

  // One tick at these speeds, by which the encoders count so many times of it.
  void Drive(WheelSpeeds wheels, double counts = 1) {
    ++tick;
    const double slip = profile_.wheel_slip;
    const WheelSpeeds slipping = {wheels.left_rad_s * (1 + random_.Gaussian(slip)),
                                  wheels.right_rad_s * (1 + random_.Gaussian(slip))};
    const WheelSpeeds ground = AsNominal(profile_.drive, profile_.wheel_error, slipping);
    truth = AdvanceArc(truth, TwistFromWheels(profile_.drive, ground), kDt_s);
    past_[tick % 64] = truth;
    Roll(profile_,
         {.wheels = {counts * wheels.left_rad_s, counts * wheels.right_rad_s},
          .dt_s = kDt_s,
          .wheel_error = slip,
          .tick = Tick{tick}},
         &odometry, &keeping);
    TakeWaiting(profile_, Taker(), &odometry, &keeping);
  }
  PoseFix FixOf(std::uint32_t at_tick, Vec2 off = {}) const {
    PoseFix fix{.world_from_body = past_[at_tick % 64],
                .sigma_position_m = kSigma_m,
                .vehicle = kOwn,
                .epoch = kKeepersEpoch,
                .tick = Tick{at_tick}};
    fix.world_from_body.position_world = fix.world_from_body.position_world + off;
    return fix;
  }
  PoseFix NoisyFix() {
    const double x_m = random_.Gaussian(kSigma_m);
    return FixOf(tick, {x_m, random_.Gaussian(kSigma_m)});
  }
  void Give(const PoseFix& fix) { Take(fix, profile_, Taker(), &odometry, &keeping); }
  FixTaker Taker() const {
    return {.vehicle = kOwn, .epoch = kKeepersEpoch, .tick = Tick{tick}, .tick_s = kDt_s};
  }
  double Off() const {
    return Norm(odometry.WorldFromBody().position_world - truth.position_world);
  }
  double Sigma() const { return SigmaPosition(PromisedCovariance(odometry, keeping)); }
  double Share() {
    return JudgeCertainty(profile_, PromisedCovariance(odometry, keeping), &keeping);
  }

  std::uint32_t tick = 0;
  Pose truth;
  Odometry odometry;
  PoseKeeping keeping;

 private:
  RobotModel profile_;
  Random random_;
  std::array<Pose, 64> past_{};
};

inline constexpr WheelSpeeds kAhead = {4, 4};
inline constexpr WheelSpeeds kBend = {3.8, 4.2};

}  // namespace giveway::test

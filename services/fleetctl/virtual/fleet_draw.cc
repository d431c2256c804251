#include "services/fleetctl/virtual/fleet_draw.h"

#include <algorithm>

#include "services/config/braking_rules.h"
#include "services/config/place_read.h"
#include "services/types/math/math.h"

namespace giveway::fleetctl {
namespace {

// From a hand-sized base to a pallet truck; speeds as in halls with people.
constexpr double kSmallest_m = 0.15;
constexpr double kSlowest_m_s = 0.2;
constexpr double kFastest_m_s = 1.0;
constexpr double kWeakest_m_s2 = 0.15;  // acceleration and braking
constexpr double kStrongest_m_s2 = 2.0;
constexpr double kLeastTurn_rad_s = 0.6;
constexpr double kMostTurn_rad_s = 2.5;
constexpr double kLongest = 2;  // a box's length to its width, at most
// More draws are not needed for something that succeeds a quarter of the time.
constexpr int kTries = 200;
// Sensors of the position: from ceiling cameras to ultra-wideband radio behind shelves.
constexpr double kMostOften_s = 0.2;
constexpr double kLeastOften_s = 2;
constexpr double kFinest_m = 0.02;
constexpr double kCoarsest_m = 0.1;
constexpr double kMostDropout = 0.3;
constexpr std::uint64_t kPoseStream = 0x706f7365;

// As many weak as strong ones, on a logarithmic scale.
double UniformRatio(double low, double high, Random* dice) {
  return low * Exp(dice->Uniform(0, Log(high / low)));
}

void DrawBody(double most_radius_m, Random* dice, RobotModel* profile) {
  profile->body_radius_m = dice->Uniform(std::min(kSmallest_m, most_radius_m), most_radius_m);
  const bool box = dice->Next() % 2 == 0;
  const double longer = dice->Uniform(1, kLongest);
  if (!box) return;
  profile->shape = BodyShape::kBox;
  const double half_width_m = profile->body_radius_m / Sqrt(1 + longer * longer);
  profile->box_half_m = {longer * half_width_m, half_width_m};
}

}  // namespace

FleetDraw::FleetDraw(const FleetChoice& choice, double most_radius_m, double delay_s, Random dice)
    : choice_(choice),
      most_radius_m_(most_radius_m),
      delay_s_(delay_s),
      dice_(dice),
      pose_dice_(Random(dice).Next(), kPoseStream) {
  if (!choice_.tiers.empty()) tier_ = choice_.tiers[dice_.Next() % choice_.tiers.size()];
  DrawPoseSensor();
}

// Nothing is drawn unless asked for: then each vehicle's wheels stay as a seed always had them.
void FleetDraw::DrawPoseSensor() {
  const double share = choice_.pose_keeping_share;
  if (share < 1 && pose_dice_.Uniform(0, 1) >= share) {
    choice_.pose_fix = {};
    choice_.most_wheel_error = 0;
    return;
  }
  if (!choice_.draws_pose_fix) return;
  choice_.pose_fix = {.every_s = UniformRatio(kMostOften_s, kLeastOften_s, &pose_dice_),
                      .sigma_m = UniformRatio(kFinest_m, kCoarsest_m, &pose_dice_),
                      .dropout = pose_dice_.Uniform(0, kMostDropout)};
}

SonarModel FleetDraw::Sonar(SonarModel sonar) const {
  if (tier_) sonar.tier = *tier_;
  return sonar;
}

// Alone, with each vehicle that is there already, and near static objects.
bool FleetDraw::ComesOut(const VehicleOptions& options) const {
  const auto with = [&](const VehicleOptions& other) {
    return SumOf(options, other, delay_s_).ComesOut();
  };
  return CanStopForStanding(options, tier_.value_or(SonarTier::kIdeal)) && with(options) &&
         std::ranges::all_of(taken_, with);
}

VehicleOptions FleetDraw::Draw(const VehicleOptions& plain) {
  VehicleOptions drawn = plain;
  DrawBody(most_radius_m_, &dice_, &drawn.profile);
  drawn.profile.acceleration_m_s2 = UniformRatio(kWeakest_m_s2, kStrongest_m_s2, &dice_);
  drawn.profile.deceleration_m_s2 = UniformRatio(kWeakest_m_s2, kStrongest_m_s2, &dice_);
  drawn.profile.max_turn_rad_s = dice_.Uniform(kLeastTurn_rad_s, kMostTurn_rad_s);
  drawn.cruise_m_s = dice_.Uniform(kSlowest_m_s, kFastest_m_s);
  return drawn;
}

void FleetDraw::DrawPoseKeeping(RobotModel* profile) {
  if (choice_.pose_fix.Fitted()) profile->pose_fix = choice_.pose_fix;
  if (choice_.most_wheel_error > 0) {
    const auto error = [&] {
      const double share = pose_dice_.Uniform(choice_.least_wheel_error, choice_.most_wheel_error);
      return pose_dice_.Next() % 2 == 0 ? share : -share;
    };
    profile->wheel_error.diameter = error();
    profile->wheel_error.axle = error();
  }
  const bool asked = choice_.pose_fix.Fitted() || choice_.most_wheel_error > 0;
  if (asked) profile->pose_limit_m = kUsualPoseLimit_m;
  if (choice_.pose_limit_m) profile->pose_limit_m = *choice_.pose_limit_m;
}

void FleetDraw::Take(VehicleOptions* options) {
  if (tier_) {
    SonarModel sonar;
    sonar.tier = *tier_;
    options->sonar_refresh = SonarRefresh(sonar, options->tick_period);
    options->sonar_noise = *tier_ == SonarTier::kIdeal ? 0 : sonar.noise;
  }
  if (choice_.most_slip > 0) {
    options->profile.wheel_slip = dice_.Uniform(choice_.least_slip, choice_.most_slip);
    options->profile.encoder_noise = dice_.Uniform(choice_.least_slip, choice_.most_slip);
  }
  DrawPoseKeeping(&options->profile);
  if (!choice_.mixed_robots) return;
  // Never of use to one that stays a Pioneer: that one comes out with all that did so far.
  for (int draw = 0; draw < kTries; ++draw) {
    const VehicleOptions drawn = Draw(*options);
    if (!ComesOut(drawn)) {
      ++refused_;
      continue;
    }
    *options = drawn;
    break;
  }
  taken_.push_back(*options);
}

}  // namespace giveway::fleetctl

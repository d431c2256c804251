#include "services/vehicle/estimation/scan_check.h"

#include <algorithm>
#include <span>

#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

// Encoders faster than the drive by this factor are broken; within it they may slip and overshoot.
constexpr double kOvershoot = 2;
constexpr double kMostCounted_rad = 1e9;  // thirty years at full speed
constexpr double kBeyondRange_m = 1;      // of noise on an echo from the edge of the range

bool IsBearing(double x) { return Magnitude(x) <= kPi + 1e-9; }

bool IsPlace(Vec2 point_world) {
  return Magnitude(point_world.x) <= kMaxCoordinate_m &&
         Magnitude(point_world.y) <= kMaxCoordinate_m;
}

struct ReadingLimits {
  Tick scanned;  // one of later would never grow old
  double max_fired_before_s;
  const RobotModel& profile;
};

bool IsBelievable(const RangeReading& reading, const ReadingLimits& limits) {
  return reading.tick <= limits.scanned &&
         IsBetween(reading.fired_before_s, 0, limits.max_fired_before_s) &&
         (reading.kind != Echo::kEcho || IsRange(reading.range_m, limits.profile));
}

}  // namespace

bool IsRange(double range_m, const RobotModel& profile) {
  return IsBetween(range_m, 0, profile.sonar_max_range_m + kBeyondRange_m);
}

bool CanBeDriven(const Twist& twist, const RobotModel& profile) {
  return Magnitude(twist.forward_m_s) <= kOvershoot * profile.max_speed_m_s &&
         Magnitude(twist.turn_rad_s) <= kOvershoot * profile.max_turn_rad_s;
}

bool IsBelievable(const RangeScan& scan, const VehicleOptions& options) {
  if (scan.epoch == kNoEpoch || scan.tick == kNoTick) return false;
  const RobotModel& profile = options.profile;
  const ReadingLimits limits = {scan.tick, Seconds(options.tick_period), profile};
  return CanBeDriven(TwistFromWheels(profile.drive, scan.wheels), profile) &&
         Magnitude(scan.counted.left_rad) <= kMostCounted_rad &&
         Magnitude(scan.counted.right_rad) <= kMostCounted_rad &&
         std::all_of(scan.readings.begin(), scan.readings.end(),
                     [&](const RangeReading& reading) { return IsBelievable(reading, limits); });
}

bool IsBelievable(const RadarScan& scan) {
  if (scan.epoch == kNoEpoch || scan.tick == kNoTick || scan.count > kMaxDetections) return false;
  const auto seen = std::span(scan.detections).first(scan.count);
  return std::all_of(seen.begin(), seen.end(), [](const RadarDetection& detection) {
    return IsBetween(detection.range_m, 0, kRadarLongRange_m + kBeyondRange_m) &&
           IsBearing(detection.bearing_rad) &&
           Magnitude(detection.range_rate_m_s) <= kOvershoot * 2 * kMaxSpeed_m_s;
  });
}

bool IsBelievable(const LidarScan& scan) {
  if (scan.epoch == kNoEpoch || scan.tick == kNoTick) return false;
  for (std::size_t i = 0; i < kLidarBeams; ++i) {
    const bool echo = scan.echo[i] == Echo::kEcho;
    if (echo && !IsBetween(scan.range_m[i], 0, kLidarRange_m + kBeyondRange_m)) return false;
  }
  return true;
}

bool IsBelievable(const CameraScan& scan) {
  if (scan.epoch == kNoEpoch || scan.tick == kNoTick || scan.count > kMaxDetections) return false;
  const auto seen = std::span(scan.objects).first(scan.count);
  return std::all_of(seen.begin(), seen.end(), [](const CameraObject& object) {
    return IsBearing(object.bearing_rad) && IsBetween(object.half_width_rad, 0, kPi);
  });
}

bool IsBelievable(const SignalState& state) {
  return state.id != kNoSignal && state.epoch != kNoEpoch && state.tick != kNoTick &&
         IsPlace(state.line_from_world) && IsPlace(state.line_to_world) &&
         IsBearing(state.travel_rad) && state.phase <= SignalPhase::kGreen;
}

}  // namespace giveway

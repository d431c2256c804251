#include "services/vehicle/scan_check.h"

#include <algorithm>

namespace giveway {
namespace {

// Encoders faster than the drive by this factor are broken; within it they may slip and overshoot.
constexpr double kOvershoot = 2;
constexpr double kBeyondRange_m = 1;  // of noise on an echo from the edge of the range

// False of NaN.
bool Within(double x, double limit) { return x >= -limit && x <= limit; }

bool IsBelievable(const RangeReading& reading, Tick scanned, double max_range_m) {
  if (reading.tick > scanned) return false;  // it would never grow old
  return reading.kind != Echo::kEcho ||
         (reading.range_m >= 0 && reading.range_m <= max_range_m + kBeyondRange_m);
}

}  // namespace

bool IsBelievable(const RangeScan& scan, const VehicleOptions& options) {
  if (scan.epoch == kNoEpoch || scan.tick == kNoTick) return false;
  const VehicleProfile& profile = options.profile;
  const Twist twist = TwistFromWheels(profile.drive, scan.wheels);
  return Within(twist.forward_m_s, kOvershoot * profile.max_speed_m_s) &&
         Within(twist.turn_rad_s, kOvershoot * profile.max_turn_rad_s) &&
         std::all_of(scan.readings.begin(), scan.readings.end(), [&](const RangeReading& reading) {
           return IsBelievable(reading, scan.tick, profile.sonar_max_range_m);
         });
}

}  // namespace giveway

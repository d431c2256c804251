// Whether a scan can be what this vehicle sensed, before anything is concluded from it.
#pragma once

#include "services/types/range_scan.h"
#include "services/types/sensor_scan.h"
#include "services/types/signal.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// False of NaN.
inline bool IsBetween(double x, double low, double high) { return x >= low && x <= high; }

// True if the drive can have moved so: no faster than it is by more than encoders slip and
// overshoot.
bool CanBeDriven(const Twist& twist, const RobotModel& profile);

// True if ultrasonics of that profile can say so.
bool IsRange(double range_m, const RobotModel& profile);

// True if every number is finite and can come from this vehicle's wheels and ultrasonics, and no
// reading is newer than the scan.
bool IsBelievable(const RangeScan& scan, const VehicleOptions& options);

// The same of the further sensors, whose limits are all vehicles' the same.
bool IsBelievable(const RadarScan& scan);
bool IsBelievable(const LidarScan& scan);
bool IsBelievable(const CameraScan& scan);
// True if the head has a place, a direction and a phase.
bool IsBelievable(const SignalState& state);

}  // namespace giveway

// How a vehicle moved in ticks whose scans it missed: its process stood still, or the scans were
// lost. Pure.
#pragma once

#include "services/types/range_scan.h"
#include "services/types/vehicle_options.h"

namespace giveway {

struct LostTicksMotion {
  WheelSpeeds wheels;    // the constant speeds that come nearest to it
  double guessed_m = 0;  // how far off that may be, as a standard deviation
};

// From `before`, the encoders' count of the last scan, to `scan`, dt_s later. Counts that the drive
// cannot have made are not believed: then all of the time is taken to have been like the last tick.
LostTicksMotion MotionOfLostTicks(const WheelAngles& before, const RangeScan& scan,
                                  const VehicleOptions& options, double dt_s);

}  // namespace giveway

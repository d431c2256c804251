// What the own ultrasonics say: each sensor is an echo, clear, or no data, judged against its age,
// with the rate at which its echo closes in. Knows no peers and decides nothing.
#pragma once

#include <array>

#include "services/types/range_scan.h"
#include "services/types/state_hash.h"
#include "services/types/vehicle_options.h"

namespace giveway {

struct SensorView {
  Echo kind = Echo::kNoData;
  double range_m = 0;        // only if kEcho
  Tick tick = kNoTick;       // when it fired
  double closing_m_s = 0;    // smoothed; positive when the echo comes nearer
  std::uint32_t streak = 0;  // echoes in a row that can be one and the same object
};

class RangeView {
 public:
  void Take(const RangeScan& scan, SteadyTime now, Nanoseconds tick_period);

  const SensorView& operator[](std::size_t sensor) const { return sensors_[sensor]; }
  // The first enabled sensor without usable data, -1 if every one has it; kSensorCount if the scan
  // as a whole is too old or has never come.
  int FirstBlind(SteadyTime now, Tick tick, const VehicleOptions& options) const;
  // The nearest echo of any sensor; negative if there is none.
  double NearestEcho() const;

  void AddTo(StateHash* hash) const;

 private:
  std::array<SensorView, kSensorCount> sensors_{};
  SteadyTime taken_{0};
  bool any_ = false;
};

}  // namespace giveway

// What the own ultrasonics say: each sensor is an echo, clear, or no data, judged against its age,
// with the rate at which its echo closes in. Knows no peers and decides nothing.
#pragma once

#include <array>

#include "services/types/range_scan.h"
#include "services/types/state_hash.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/estimation/bits.h"

namespace giveway {

// How far a vehicle has come: driven forward, less backward, and turned to either side, in all.
struct OwnDisplacement {
  double driven_m = 0;
  double turned_rad = 0;
};

struct SensorView {
  Echo kind = Echo::kNoData;
  double range_m = 0;        // only if kEcho
  Tick tick = kNoTick;       // when it fired last
  Tick echo_tick = kNoTick;  // when it heard range_m, and how long before that tick
  double echo_before_s = 0;  // (see RangeReading)
  bool missed = false;       // it has heard nothing since: perhaps a drop-out, perhaps gone
  double closing_m_s = 0;    // smoothed; positive when the echo comes nearer
  std::uint32_t streak = 0;  // echoes in a row that can be one and the same object
  // Of imperfect ultrasonics: the own motion (absolute turn rate) over the time closing_m_s is
  // made from, smoothed alike; where the vehicle was when it heard range_m, by the odometer.
  Twist own;
  OwnDisplacement echo_displacement;
};

// Seconds since the transducer fired that heard range_m.
double EchoAge(const SensorView& view, Tick tick, Nanoseconds tick_period);

// Readings jitter, so a rate is taken over about this long: however often the transducer fires, the
// rate then has a standard deviation of at most that of a reading over this time.
inline constexpr double kClosingTime_s = 0.4;

// A jump between two readings faster than this is another object, not motion of the same one: two
// vehicles at the profile's top speed of 1.0 m/s close at 2.0 m/s.
inline constexpr double kMaxClosing_m_s = 2.5;

// True if the vehicle's ultrasonics are to be taken with TakeImperfect.
inline bool HasImperfectSonar(const VehicleOptions& options) {
  return options.sonar_refresh.count() > 0 || options.sonar_noise > 0;
}

class RangeView {
 public:
  // Exact ultrasonics: every reading is what is there now.
  void Take(const RangeScan& scan, SteadyTime now, Nanoseconds tick_period);
  // Ultrasonics that jitter, drop out or fire in turn: an echo is forgotten only after two firings
  // in a row heard nothing, and a closing speed is smoothed over kClosingTime_s. `moved` is the own
  // displacement since the scan before.
  void TakeImperfect(const RangeScan& scan, SteadyTime now, Nanoseconds tick_period,
                     OwnDisplacement moved);

  const SensorView& operator[](std::size_t sensor) const { return sensors_[sensor]; }
  // Which sensors hold an echo: bit i for sensor i.
  std::uint32_t Echoes() const { return echoes_; }
  // Which sensors fired for this very tick and say something, be it that nothing is there; none of
  // those that may have dropped out.
  std::uint32_t SpokeAt(Tick tick) const { return tick == spoke_tick_ ? spoke_ : 0; }
  // The first of the `enabled` sensors without usable data, -1 if every one has it; kSensorCount if
  // the scan as a whole is too old or has never come. A reading may be older by the sonar's
  // refresh.
  int FirstBlind(SteadyTime now, Tick tick, const VehicleOptions& options,
                 std::uint32_t enabled) const;
  // The nearest echo of any sensor; negative if there is none.
  double NearestEcho() const;

  void AddTo(StateHash* hash) const;

 private:
  friend struct StateFields;  // services/snapshot
  void Mark(std::size_t sensor);
  void NoteWhoSpoke(Tick tick);

  std::array<SensorView, kSensorCount> sensors_{};
  std::uint32_t echoes_ = 0;
  std::uint32_t spoke_ = 0;  // see SpokeAt; of the scan last taken
  Tick spoke_tick_ = kNoTick;
  OwnDisplacement displacement_;
  SteadyTime taken_{0};
  bool any_ = false;
};

}  // namespace giveway

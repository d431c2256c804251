#include "services/vehicle/range_view.h"

namespace giveway {
namespace {

// A jump between two readings faster than this is another object, not motion of the same one: two
// vehicles at the profile's top speed of 1.0 m/s close at 2.0 m/s.
constexpr double kMaxClosing_m_s = 2.5;

// One reading into the sensor's running view. Ranges in m, dt in s.
void Update(SensorView* view, const RangeReading& reading, double dt_s) {
  const bool both_echo = view->kind == Echo::kEcho && reading.kind == Echo::kEcho && dt_s > 0;
  const double closing = both_echo ? (view->range_m - reading.range_m) / dt_s : 0;
  if (both_echo && closing < kMaxClosing_m_s && closing > -kMaxClosing_m_s) {
    view->closing_m_s = view->streak == 0 ? closing : 0.5 * (view->closing_m_s + closing);
    ++view->streak;
  } else {
    view->closing_m_s = 0;
    view->streak = 0;
  }
  view->kind = reading.kind;
  view->range_m = reading.range_m;
  view->tick = reading.tick;
}

}  // namespace

void RangeView::Take(const RangeScan& scan, SteadyTime now, Nanoseconds tick_period) {
  taken_ = now;
  any_ = true;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const RangeReading& reading = scan.readings[i];
    const bool same = reading.tick == sensors_[i].tick && reading.kind == sensors_[i].kind;
    if (same) continue;  // the sensor has not fired again
    const double dt_s = Seconds(TicksBetween(sensors_[i].tick, reading.tick) * tick_period);
    Update(&sensors_[i], reading, dt_s);
  }
}

int RangeView::FirstBlind(SteadyTime now, Tick tick, const VehicleOptions& options) const {
  if (!any_ || now - taken_ > options.ranges_age_limit) return kSensorCount;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (!options.profile.sonar[i].enabled) continue;
    const auto age = TicksBetween(sensors_[i].tick, tick) * options.tick_period;
    if (sensors_[i].kind == Echo::kNoData || age > options.ranges_age_limit) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

double RangeView::NearestEcho() const {
  double nearest = -1;
  for (const SensorView& view : sensors_) {
    if (view.kind != Echo::kEcho) continue;
    if (nearest < 0 || view.range_m < nearest) nearest = view.range_m;
  }
  return nearest;
}

void RangeView::AddTo(StateHash* hash) const {
  for (const SensorView& view : sensors_) {
    hash->Add(view.kind);
    hash->Add(view.range_m);
    hash->Add(view.tick);
    hash->Add(view.closing_m_s);
    hash->Add(view.streak);
  }
  hash->Add(taken_.count());
}

}  // namespace giveway

#include "services/vehicle/estimation/range_view.h"

#include "services/types/math/math.h"

namespace giveway {
namespace {

void Hear(SensorView* view, const RangeReading& reading) {
  view->kind = reading.kind;
  view->range_m = reading.range_m;
  view->tick = reading.tick;
  view->echo_tick = reading.tick;
  view->echo_before_s = reading.fired_before_s;
  view->missed = false;
}

// Seconds from the firing of the echo held to that of `reading`.
double SecondsBetween(const SensorView& view, const RangeReading& reading,
                      Nanoseconds tick_period) {
  return Seconds(TicksBetween(view.echo_tick, reading.tick) * tick_period) + view.echo_before_s -
         reading.fired_before_s;
}

// One reading into the sensor's running view.
void Update(SensorView* view, const RangeReading& reading, Nanoseconds tick_period) {
  const bool both_echo = view->kind == Echo::kEcho && reading.kind == Echo::kEcho;
  const double dt_s = both_echo ? SecondsBetween(*view, reading, tick_period) : 0;
  const double closing = dt_s > 0 ? (view->range_m - reading.range_m) / dt_s : 0;
  if (dt_s > 0 && Magnitude(closing) < kMaxClosing_m_s) {  // of one and the same object
    view->closing_m_s = view->streak == 0 ? closing : 0.5 * (view->closing_m_s + closing);
    ++view->streak;
  } else {
    view->closing_m_s = 0;
    view->streak = 0;
  }
  Hear(view, reading);
}

void UpdateImperfect(SensorView* view, const RangeReading& reading, Nanoseconds tick_period,
                     const OwnDisplacement& displacement) {
  if (view->kind == Echo::kEcho && reading.kind == Echo::kClear && !view->missed) {
    view->missed = true;
    view->tick = reading.tick;
    return;
  }
  const double dt_s = SecondsBetween(*view, reading, tick_period);
  const bool both_echo = view->kind == Echo::kEcho && reading.kind == Echo::kEcho && dt_s > 0;
  const double closing = both_echo ? (view->range_m - reading.range_m) / dt_s : 0;
  if (both_echo && Magnitude(closing) < kMaxClosing_m_s) {
    // From 0 on, so that the jitter of the first two readings weighs no more than any other's.
    const double weight = dt_s / (dt_s + kClosingTime_s);
    const double driven = (displacement.driven_m - view->echo_displacement.driven_m) / dt_s;
    const double turned = (displacement.turned_rad - view->echo_displacement.turned_rad) / dt_s;
    view->closing_m_s += weight * (closing - view->closing_m_s);
    view->own.forward_m_s += weight * (driven - view->own.forward_m_s);
    view->own.turn_rad_s += weight * (turned - view->own.turn_rad_s);
    ++view->streak;
  } else {
    view->closing_m_s = 0;
    view->own = {};
    view->streak = 0;
  }
  Hear(view, reading);
  view->echo_displacement = displacement;
}

// The sensor has not fired again.
bool IsSame(const SensorView& view, const RangeReading& reading) {
  if (reading.tick != view.tick) return false;
  return reading.kind == view.kind || (view.missed && reading.kind == Echo::kClear);
}

}  // namespace

double EchoAge(const SensorView& view, Tick tick, Nanoseconds tick_period) {
  return Seconds(TicksBetween(view.echo_tick, tick) * tick_period) + view.echo_before_s;
}

void RangeView::Mark(std::size_t sensor) {
  const std::uint32_t bit = 1U << sensor;
  echoes_ = sensors_[sensor].kind == Echo::kEcho ? echoes_ | bit : echoes_ & ~bit;
}

void RangeView::NoteWhoSpoke(Tick tick) {
  spoke_ = 0;
  spoke_tick_ = tick;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const SensorView& view = sensors_[i];
    const bool spoke = view.tick == tick && view.kind != Echo::kNoData && !view.missed;
    spoke_ |= (spoke ? 1U : 0U) << i;
  }
}

void RangeView::Take(const RangeScan& scan, SteadyTime now, Nanoseconds tick_period) {
  taken_ = now;
  any_ = true;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (IsSame(sensors_[i], scan.readings[i])) continue;
    Update(&sensors_[i], scan.readings[i], tick_period);
    Mark(i);
  }
  NoteWhoSpoke(scan.tick);
}

void RangeView::TakeImperfect(const RangeScan& scan, SteadyTime now, Nanoseconds tick_period,
                              OwnDisplacement moved) {
  taken_ = now;
  any_ = true;
  displacement_.driven_m += moved.driven_m;
  displacement_.turned_rad += moved.turned_rad;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (IsSame(sensors_[i], scan.readings[i])) continue;
    UpdateImperfect(&sensors_[i], scan.readings[i], tick_period, displacement_);
    Mark(i);
  }
  NoteWhoSpoke(scan.tick);
}

int RangeView::FirstBlind(SteadyTime now, Tick tick, const VehicleOptions& options,
                          std::uint32_t enabled) const {
  if (!any_ || now - taken_ > options.ranges_age_limit) return kSensorCount;
  const Nanoseconds limit = options.ranges_age_limit + options.sonar_refresh;
  for (const std::size_t i : BitsOf(enabled & ~SpokeAt(tick))) {
    const bool old = TicksBetween(sensors_[i].tick, tick) * options.tick_period > limit;
    if (old || sensors_[i].kind == Echo::kNoData) return static_cast<int>(i);
  }
  return -1;
}

double RangeView::NearestEcho() const {
  double nearest = -1;
  for (const std::size_t i : BitsOf(echoes_)) {
    if (nearest < 0 || sensors_[i].range_m < nearest) nearest = sensors_[i].range_m;
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
    if (view.missed) hash->Add(view.echo_tick);
    if (view.echo_before_s != 0) hash->Add(view.echo_before_s);
  }
  hash->Add(taken_.count());
}

}  // namespace giveway

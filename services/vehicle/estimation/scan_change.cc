#include "services/vehicle/estimation/scan_change.h"

#include <bit>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/bits.h"

namespace giveway {
namespace {

// Cones start apart from each other: so near, a thin body lies in none of them.
constexpr double kTooNear_m = 0.4;

// What the sensor said last. One that has missed an echo still holds it.
Echo LastKind(const SensorView& view) { return view.missed ? Echo::kClear : view.kind; }

bool SaysTheSame(const SensorView& view, const RangeReading& reading) {
  if (LastKind(view) != reading.kind) return false;
  return reading.kind != Echo::kEcho || view.range_m == reading.range_m;
}

// True if what is heard, or not heard any more, cannot have moved so since the firing before. An
// echo may come and go at the end of the range.
bool IsLeap(const SensorView& view, const RangeReading& reading, const VehicleOptions& options) {
  const double most_m =
      kMaxClosing_m_s * Seconds(TicksBetween(view.tick, reading.tick) * options.tick_period);
  const double max_range_m = options.profile.sonar_max_range_m;
  const bool was_echo = LastKind(view) == Echo::kEcho;
  const bool is_echo = reading.kind == Echo::kEcho;
  if (was_echo && is_echo) return Magnitude(reading.range_m - view.range_m) > most_m;
  if (was_echo) return view.range_m + most_m < max_range_m;
  return is_echo && reading.range_m + most_m < max_range_m;
}

// Of one scan against the one before: bit i for sensor i.
struct Tally {
  std::uint32_t fired = 0;
  std::uint32_t echoes = 0;  // of these
  std::uint32_t same = 0;    // of these
  std::uint32_t leaps = 0;   // of these
};

Tally TallyOf(const RangeView& before, const RangeScan& scan, const VehicleOptions& options,
              std::uint32_t enabled) {
  Tally tally;
  for (const std::size_t i : BitsOf(enabled)) {
    const RangeReading& reading = scan.readings[i];
    if (reading.tick == before[i].tick || reading.kind == Echo::kNoData) continue;  // not fired
    const std::uint32_t bit = 1U << i;
    tally.fired |= bit;
    if (reading.kind == Echo::kEcho) tally.echoes |= bit;
    if (SaysTheSame(before[i], reading)) tally.same |= bit;
    if (IsLeap(before[i], reading, options)) tally.leaps |= bit;
  }
  return tally;
}

// Of a scan without an echo; what vanished is among the leaps.
ScanChange AllClear(const RangeView& before, Tick tick, std::uint32_t leaps) {
  ScanChange change{.news = ScanNews::kAllClear};
  for (const std::size_t i : BitsOf(leaps)) {
    const SensorView& view = before[i];
    if (TicksBetween(view.tick, tick) != 1 || view.range_m < kTooNear_m) continue;
    change.echoes |= 1U << i;
    change.was_m[i] = view.range_m;
  }
  return change;
}

}  // namespace

ScanChange ChangeOf(const RangeView& before, const RangeScan& scan, const VehicleOptions& options,
                    const Cones& cones) {
  const Tally tally = TallyOf(before, scan, options, cones.enabled);
  if (tally.fired == 0) return {};
  if (tally.fired == cones.enabled && tally.echoes == 0)
    return AllClear(before, scan.tick, tally.leaps & cones.amid);
  if (tally.same == tally.fired) {
    if (tally.echoes == 0) return {};
    return {.news = ScanNews::kSame, .echoes = tally.echoes};
  }
  const bool most_leap = 2 * std::popcount(tally.leaps) > std::popcount(cones.enabled);
  return {.news = most_leap ? ScanNews::kLeaps : ScanNews::kOther};
}

}  // namespace giveway

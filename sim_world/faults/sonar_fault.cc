#include "sim_world/faults/sonar_fault.h"

#include <algorithm>

#include "services/types/math/random.h"
#include "services/types/time.h"

namespace giveway::sim {
namespace {

constexpr double kMostDelay_s = 10;
constexpr double kClearOfGarbage = 0.25;

void Silence(RangeReading* reading) {
  if (reading->kind != Echo::kEcho) return;
  reading->kind = Echo::kClear;
  reading->range_m = 0;
}

void Silence(RangeScan* scan) {
  for (RangeReading& reading : scan->readings) Silence(&reading);
}

}  // namespace

SonarFault::SonarFault(const faults::Fault& fault, std::uint64_t draws, Nanoseconds tick_period)
    : kind_(fault.kind),
      factor_(fault.parameters.factor.value_or(1)),
      probability_(fault.parameters.probability.value_or(0)),
      every_ticks_(std::max(
          1U, TicksCovering(FromSeconds(fault.parameters.period_s.value_or(0)), tick_period))),
      behind_ticks_(TicksCovering(
          FromSeconds(std::min(kMostDelay_s, fault.parameters.delay_s.value_or(0))), tick_period)),
      draws_(draws) {}

void SonarFault::Alter(const RobotModel& profile, std::uint32_t driven_tick, RangeScan* scan) {
  switch (kind_) {
    case faults::Kind::kSonarOff:
      Silence(scan);
      break;
    case faults::Kind::kSonarStuck:
      Freeze(scan);
      break;
    case faults::Kind::kSonarGarbage:
      Scramble(profile, driven_tick, scan);
      break;
    case faults::Kind::kSonarWrong:
      Scale(profile, scan);
      break;
    case faults::Kind::kSonarSlow:
      Hold(scan);
      break;
    case faults::Kind::kSonarDelayed:
      Delay(scan);
      break;
    case faults::Kind::kSonarIntermittent:
      if (Random(draws_, driven_tick).Uniform(0, 1) < probability_) Silence(scan);
      break;
    default:
      break;
  }
  ++scans_;
}

void SonarFault::Hold(RangeScan* scan) {
  if (scans_ % every_ticks_ == 0) kept_.assign(1, scan->readings);
  scan->readings = kept_.front();
}

// A ring buffer: the oldest entry is read and overwritten.
void SonarFault::Delay(RangeScan* scan) {
  if (behind_ticks_ == 0) return;
  if (kept_.empty()) kept_.assign(behind_ticks_, scan->readings);
  std::swap(scan->readings, kept_[scans_ % behind_ticks_]);
}

// A stuck transducer keeps firing, and nothing in the scan shows that its reading is old.
void SonarFault::Freeze(RangeScan* scan) {
  if (kept_.empty()) kept_.assign(1, scan->readings);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    RangeReading& reading = scan->readings[i];
    if (reading.kind == Echo::kNoData) continue;
    reading.kind = kept_.front()[i].kind;
    reading.range_m = kept_.front()[i].range_m;
  }
}

// Drawn per firing: a reading stays the same until its transducer fires again.
void SonarFault::Scramble(const RobotModel& profile, std::uint32_t driven_tick,
                          RangeScan* scan) const {
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    RangeReading& reading = scan->readings[i];
    if (reading.kind == Echo::kNoData) continue;
    const std::uint64_t fired = std::uint64_t{driven_tick} - TicksBetween(reading.tick, scan->tick);
    Random random(draws_, fired << 8 | i);
    const bool clear = random.Uniform(0, 1) < kClearOfGarbage;
    reading.kind = clear ? Echo::kClear : Echo::kEcho;
    reading.range_m = clear ? 0 : random.Uniform(0, profile.sonar_max_range_m);
  }
}

void SonarFault::Scale(const RobotModel& profile, RangeScan* scan) const {
  for (RangeReading& reading : scan->readings) {
    if (reading.kind != Echo::kEcho) continue;
    reading.range_m *= factor_;
    if (reading.range_m > profile.sonar_max_range_m) Silence(&reading);
  }
}

}  // namespace giveway::sim

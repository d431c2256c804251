#include "sim_world/attendance.h"

#include <algorithm>

#include "sim_world/ticks.h"

namespace giveway::sim {
namespace {

constexpr Nanoseconds kSilence{1'000'000'000};

}  // namespace

Attendance::Attendance(const Scenario& scenario)
    : silence_ticks_(TicksCovering(kSilence, scenario.tick_period)),
      removal_ticks_(TicksCovering(FromSeconds(scenario.remove_after_s), scenario.tick_period)) {
  entries_.reserve(scenario.vehicles.size());
}

void Attendance::Join(VehicleId vehicle, Tick tick) {
  entries_.push_back({.vehicle = vehicle, .heard = tick});
}

void Attendance::Start(Tick tick) {
  for (Entry& entry : entries_) entry.heard = tick;
}

void Attendance::Heard(VehicleId vehicle, Tick tick) {
  const auto entry = std::ranges::find(entries_, vehicle, &Entry::vehicle);
  if (entry != entries_.end()) entry->heard = tick;
}

bool Attendance::IsSilent(VehicleId vehicle) const {
  const auto entry = std::ranges::find(entries_, vehicle, &Entry::vehicle);
  return entry != entries_.end() && entry->silent_since.has_value();
}

VehicleId Attendance::TakeNewlySilent(Tick tick) {
  for (Entry& entry : entries_) {
    if (entry.silent_since || TicksBetween(entry.heard, tick) < silence_ticks_) continue;
    entry.silent_since = tick;
    return entry.vehicle;
  }
  return kNobody;
}

VehicleId Attendance::TakeOverdueBody(Tick tick) {
  for (Entry& entry : entries_) {
    if (!entry.silent_since || entry.removed) continue;
    if (TicksBetween(*entry.silent_since, tick) < removal_ticks_) continue;
    entry.removed = true;
    return entry.vehicle;
  }
  return kNobody;
}

}  // namespace giveway::sim

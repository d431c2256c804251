#include "sim_world/run/liveness_monitor.h"

#include <algorithm>
#include <utility>

#include "services/types/time.h"

namespace giveway::sim {
namespace {

// From joining to the first command: its endpoints must be created and discovered first.
constexpr Nanoseconds kFirstSample{5'000'000'000};
// From then to the removal of its body, at most: it was not driven, and its place is needed.
constexpr Nanoseconds kNeverSpoke{5'000'000'000};

}  // namespace

LivenessMonitor::LivenessMonitor(const Scenario& scenario)
    : silence_ticks_(TicksCovering(SilenceIn(scenario.tick_period), scenario.tick_period)),
      removal_ticks_(TicksCovering(FromSeconds(scenario.remove_after_s), scenario.tick_period)),
      first_sample_ticks_(TicksCovering(kFirstSample, scenario.tick_period)),
      never_spoke_ticks_(
          std::min(removal_ticks_, TicksCovering(kNeverSpoke, scenario.tick_period))) {
  entries_.reserve(scenario.vehicles.size());
}

const LivenessMonitor::Entry* LivenessMonitor::Find(VehicleId vehicle) const {
  const auto entry = std::ranges::lower_bound(entries_, vehicle, {}, &Entry::vehicle);
  return entry == entries_.end() || entry->vehicle != vehicle ? nullptr : &*entry;
}

LivenessMonitor::Entry* LivenessMonitor::Find(VehicleId vehicle) {
  return const_cast<Entry*>(std::as_const(*this).Find(vehicle));
}

void LivenessMonitor::Join(VehicleId vehicle, Tick tick) {
  const Entry entry{.vehicle = vehicle, .heard = tick};
  if (Entry* known = Find(vehicle)) {
    *known = entry;
  } else {
    entries_.insert(std::ranges::lower_bound(entries_, vehicle, {}, &Entry::vehicle), entry);
  }
}

void LivenessMonitor::Leave(VehicleId vehicle) {
  std::erase_if(entries_, [&](const Entry& entry) { return entry.vehicle == vehicle; });
}

void LivenessMonitor::Start(Tick tick) {
  for (Entry& entry : entries_) {
    entry.heard = tick;
    entry.spoke = true;
  }
}

void LivenessMonitor::Heard(VehicleId vehicle, Tick tick) {
  Entry* entry = Find(vehicle);
  if (entry == nullptr) return;
  entry->heard = tick;
  entry->spoke = true;
}

bool LivenessMonitor::IsSilent(VehicleId vehicle) const {
  const Entry* entry = Find(vehicle);
  return entry != nullptr && entry->silent_since.has_value();
}

bool LivenessMonitor::IsAbandoned(VehicleId vehicle, Tick tick) const {
  const Entry* entry = Find(vehicle);
  return entry == nullptr || entry->silent_since || IsUnheard(*entry, tick);
}

bool LivenessMonitor::IsUnheard(const Entry& entry, Tick tick) const {
  return TicksBetween(entry.heard, tick) >= (entry.spoke ? silence_ticks_ : first_sample_ticks_);
}

VehicleId LivenessMonitor::TakeNewlySilent(Tick tick) {
  for (Entry& entry : entries_) {
    if (entry.silent_since || !IsUnheard(entry, tick)) continue;
    entry.silent_since = tick;
    return entry.vehicle;
  }
  return kNoVehicle;
}

VehicleId LivenessMonitor::TakeOverdueBody(Tick tick) {
  for (Entry& entry : entries_) {
    if (!entry.silent_since || entry.removed) continue;
    const std::uint32_t patience = entry.spoke ? removal_ticks_ : never_spoke_ticks_;
    if (TicksBetween(*entry.silent_since, tick) < patience) continue;
    entry.removed = true;
    return entry.vehicle;
  }
  return kNoVehicle;
}

}  // namespace giveway::sim

#include "services/observer/fleet/fleet_snapshot.h"

#include <algorithm>

namespace giveway {
namespace {

constexpr SteadyTime kSettleTime = std::chrono::seconds(1);
// What was missed of a vehicle's endpoints is said again by the library within three seconds.
constexpr SteadyTime kStatusTime = std::chrono::seconds(4);

}  // namespace

std::string_view Name(Liveness liveness) {
  switch (liveness) {
    case Liveness::kNever:
      return "not_heard";
    case Liveness::kHeard:
      return "heard";
    case Liveness::kSilent:
      return "silent";
    case Liveness::kLeft:
      return "left";
  }
  return "unknown";
}

std::optional<SteadyTime> VehicleSnapshot::HeardAt() const {
  if (!status_at) return beacon_at;
  return beacon_at ? std::max(*status_at, *beacon_at) : *status_at;
}

Liveness VehicleSnapshot::LivenessAt(SteadyTime now) const {
  if (!HeardAt()) return Liveness::kNever;
  if (status && status->final) return Liveness::kLeft;
  return now - *HeardAt() > FleetSnapshot::kSilentAfter ? Liveness::kSilent : Liveness::kHeard;
}

void FleetSnapshot::MakeRoom() {
  const auto heard_at = [](const auto& entry) {
    return entry.second.HeardAt().value_or(SteadyTime{0});
  };
  vehicles_.erase(std::ranges::min_element(vehicles_, {}, heard_at));
}

VehicleSnapshot& FleetSnapshot::Known(VehicleId vehicle, SteadyTime now) {
  if (vehicles_.size() >= kMostVehicles && !vehicles_.contains(vehicle)) MakeRoom();
  const auto [entry, is_new] = vehicles_.try_emplace(vehicle);
  if (is_new) newcomer_at_ = now;
  return entry->second;
}

// Whatever an earlier world said of the run no longer holds.
void FleetSnapshot::HearWorld(WorldEpoch epoch, SteadyTime now) {
  if (!world_.heard_at) newcomer_at_ = now;
  if (epoch != world_.epoch) world_ = {};
  world_.epoch = epoch;
  world_.heard_at = now;
}

void FleetSnapshot::FoldTruth(const Truth& truth, SteadyTime now) {
  HearWorld(truth.epoch, now);
  world_.time_s = std::max(world_.time_s, truth.time_s);
  if (truth.present) Known(truth.vehicle, now);
}

void FleetSnapshot::FoldEvent(const WorldEvent& event, SteadyTime now) {
  HearWorld(event.epoch, now);
  world_.time_s = std::max(world_.time_s, event.time_s);
  world_.last_event = event;
  if (event.kind == EventKind::kStarted) world_.state = RunState::kRunning;
  if (event.kind == EventKind::kEnded) world_.state = RunState::kEnded;
}

void FleetSnapshot::Fold(const link::Observed& observed, SteadyTime now) {
  for (const RosterEntry& entry : observed.roster) {
    HearWorld(entry.epoch, now);
    world_.state = std::max(world_.state.value_or(RunState::kWaiting), entry.run_state);
    world_.fleet_size = entry.fleet_size;
  }
  for (const WorldEvent& event : observed.events) FoldEvent(event, now);
  for (const Truth& truth : observed.truths) FoldTruth(truth, now);
  for (const ReceivedBeacon& received : observed.beacons) {
    if (!received.crc_valid || !received.name_valid) continue;
    VehicleSnapshot& vehicle = Known(received.beacon.vehicle, now);
    vehicle.beacon = received.beacon;
    vehicle.beacon_at = now;
  }
  for (const VehicleStatus& status : observed.statuses) {
    VehicleSnapshot& vehicle = Known(status.vehicle, now);
    vehicle.status = status;
    vehicle.status_at = now;
  }
}

bool FleetSnapshot::IsSettled(SteadyTime now) const {
  if (!IsAnyHeard() || now - newcomer_at_ < kSettleTime) return false;
  const bool has_time = now - newcomer_at_ < kStatusTime;
  return std::ranges::none_of(vehicles_, [has_time](const auto& entry) {
    const VehicleSnapshot& vehicle = entry.second;
    return !vehicle.HeardAt() || (has_time && !vehicle.status);
  });
}

}  // namespace giveway

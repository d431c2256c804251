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

bool WorldSnapshot::IsHeard(SteadyTime now) const {
  return is_empty || (heard_at && now - *heard_at <= FleetSnapshot::kSilentAfter);
}

void FleetSnapshot::MakeRoom() {
  const auto heard_at = [](const auto& entry) {
    return entry.second.HeardAt().value_or(SteadyTime{0});
  };
  vehicles_.erase(std::ranges::min_element(vehicles_, {}, heard_at));
}

// One that was never heard has nothing to show once its body is gone.
void FleetSnapshot::DropGone(SteadyTime now) {
  std::erase_if(vehicles_, [now](const auto& entry) {
    const VehicleSnapshot& vehicle = entry.second;
    return !vehicle.has_body &&
           (!vehicle.HeardAt() || now - *vehicle.HeardAt() > FleetSnapshot::kDroppedAfter);
  });
}

VehicleSnapshot& FleetSnapshot::Known(VehicleId vehicle, SteadyTime now) {
  if (vehicles_.size() >= kMostVehicles && !vehicles_.contains(vehicle)) MakeRoom();
  const auto [entry, is_new] = vehicles_.try_emplace(vehicle);
  if (is_new) newcomer_at_ = now;
  return entry->second;
}

// Whatever an earlier world said of the run and of bodies no longer holds.
void FleetSnapshot::HearWorld(WorldEpoch epoch, SteadyTime now) {
  if (!world_.heard_at) newcomer_at_ = now;
  if (epoch != world_.epoch) {
    world_ = {};
    for (auto& [id, vehicle] : vehicles_) vehicle.has_body = false;
  }
  world_.epoch = epoch;
  world_.heard_at = now;
}

// Another participant than the one with the bodies is a world that was started again, and has none
// before its first truth.
void FleetSnapshot::FindWorld(std::uint64_t participant) {
  const bool has_bodies =
      std::ranges::any_of(vehicles_, [](const auto& entry) { return entry.second.has_body; });
  world_.is_empty = participant != 0 && (!has_bodies || participant != world_of_bodies_);
}

void FleetSnapshot::FoldTruth(const Truth& truth, SteadyTime now) {
  HearWorld(truth.epoch, now);
  world_.time_s = std::max(world_.time_s, truth.time_s);
  if (truth.present) {
    Known(truth.vehicle, now).has_body = true;
  } else if (const auto known = vehicles_.find(truth.vehicle); known != vehicles_.end()) {
    known->second.has_body = false;
  }
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
  if (!observed.truths.empty()) world_of_bodies_ = observed.world;
  FindWorld(observed.world);
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
  DropGone(now);
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

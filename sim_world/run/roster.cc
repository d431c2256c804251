#include "sim_world/run/roster.h"

#include <algorithm>
#include <utility>

#include "services/types/check.h"
#include "services/types/fleet_limits.h"

namespace giveway::sim {

Roster::Roster(const Scenario& scenario, WorldEpoch epoch)
    : epoch_(epoch),
      open_(IsOpen(scenario)),
      fleet_size_(open_ ? std::max(1U, scenario.start_with)
                        : static_cast<std::uint32_t>(scenario.vehicles.size())),
      named_(scenario.vehicles),
      spawns_(scenario.spawns) {
  for (const VehicleOptions& options : named_) slots_.push_back({.vehicle = options.id});
}

RosterEntry Roster::Admit(const JoinRequest& request, const SlotQuestions& ask) {
  if (const Slot* slot = SlotOf(request.session)) return Accept(*slot);
  if (request.wanted == kNoVehicle) return AdmitAny(request, ask);
  if (Slot* slot = Find(request.wanted)) return AdmitTo(slot, request, ask);
  if (open_) return AdmitBySpawn(request.wanted, request, ask);
  return Refuse(request, "id " + std::to_string(Number(request.wanted)) + " is not in the scenario",
                false);
}

RosterEntry Roster::AdmitAny(const JoinRequest& request, const SlotQuestions& ask) {
  if (open_) return AdmitBySpawn(LowestFree(), request, ask);
  const auto can_have = [&](const Slot& slot) {
    return (!slot.taken || ask.is_silent(slot.vehicle)) && ask.is_free(OptionsOf(slot));
  };
  const auto slot = std::ranges::find_if(slots_, can_have);
  if (slot == slots_.end()) return Refuse(request, "the fleet is full", true);
  return AdmitTo(&*slot, request, ask);
}

RosterEntry Roster::AdmitTo(Slot* slot, const JoinRequest& request, const SlotQuestions& ask) {
  const std::string id = "id " + std::to_string(Number(slot->vehicle));
  if (slot->taken && !ask.is_silent(slot->vehicle)) {
    return Refuse(request, id + " is taken by another session", true);
  }
  if (!ask.is_free(OptionsOf(*slot))) {
    return Refuse(request, "the start place of " + id + " is not free", true);
  }
  if (!slot->taken && IsFull()) return Refuse(request, "the fleet is full", true);
  slot->taken = true;
  slot->session = request.session;
  return Accept(*slot);
}

RosterEntry Roster::AdmitBySpawn(VehicleId vehicle, const JoinRequest& request,
                                 const SlotQuestions& ask) {
  if (IsFull()) return Refuse(request, "the fleet is full", true);
  for (std::uint32_t spawn = 1; spawn <= spawns_.size(); ++spawn) {
    const Slot slot{vehicle, spawn, true, request.session};
    if (IsPatrolled(spawn) || !ask.is_free(OptionsOf(slot))) continue;
    const auto at = std::ranges::lower_bound(slots_, vehicle, {}, &Slot::vehicle);
    return Accept(*slots_.insert(at, slot));
  }
  return Refuse(request, "no start place is free", true);
}

// Places that the scenario names, and that no session has, are not vehicles yet.
bool Roster::IsFull() const {
  return open_ && std::ranges::count_if(slots_, &Slot::taken) >= kMaxOpenFleet;
}

// A vehicle on a looping route returns to its start: another one must not start there.
bool Roster::IsPatrolled(std::uint32_t spawn) const {
  return spawns_[spawn - 1].route.loop &&
         std::ranges::find(slots_, spawn, &Slot::spawn) != slots_.end();
}

VehicleId Roster::LowestFree() const {
  std::uint32_t lowest = 1;
  for (const Slot& slot : slots_) {  // sorted; named ones are always there
    if (Number(slot.vehicle) == lowest) ++lowest;
  }
  return VehicleId{lowest};
}

void Roster::Free(VehicleId vehicle) {
  Slot* slot = Find(vehicle);
  if (slot == nullptr) return;
  if (IsNamed(vehicle)) {
    *slot = {.vehicle = vehicle};
  } else {
    slots_.erase(slots_.begin() + (slot - slots_.data()));
  }
}

const Slot* Roster::SlotOf(const SessionId& session) const {
  const auto has = [&](const Slot& slot) { return slot.taken && slot.session == session; };
  const auto slot = std::ranges::find_if(slots_, has);
  return slot == slots_.end() ? nullptr : &*slot;
}

Slot* Roster::Find(VehicleId vehicle) {
  const auto slot = std::ranges::lower_bound(slots_, vehicle, {}, &Slot::vehicle);
  return slot == slots_.end() || slot->vehicle != vehicle ? nullptr : &*slot;
}

bool Roster::IsNamed(VehicleId vehicle) const {
  return std::ranges::binary_search(named_, vehicle, {}, &VehicleOptions::id);
}

VehicleOptions Roster::OptionsOf(const Slot& slot) const {
  if (slot.spawn == 0) {
    return *std::ranges::lower_bound(named_, slot.vehicle, {}, &VehicleOptions::id);
  }
  VehicleOptions options = spawns_[slot.spawn - 1];
  options.id = slot.vehicle;
  return options;
}

bool Roster::Restore(std::span<const Slot> slots) {
  const auto fits = [&](const Slot& slot) {
    return slot.spawn == 0 ? IsNamed(slot.vehicle)
                           : slot.spawn <= spawns_.size() && !IsNamed(slot.vehicle);
  };
  if (!std::ranges::all_of(slots, fits)) return false;
  for (const Slot& slot : slots) {
    if (Slot* known = Find(slot.vehicle)) {
      *known = slot;
    } else {
      slots_.insert(std::ranges::lower_bound(slots_, slot.vehicle, {}, &Slot::vehicle), slot);
    }
  }
  return true;
}

RosterEntry Roster::Accept(const Slot& slot) const {
  return {.session = slot.session,
          .vehicle = slot.vehicle,
          .accepted = true,
          .epoch = epoch_,
          .start_world = OptionsOf(slot).start_world,
          .spawn = slot.spawn,
          .fleet_size = fleet_size_};
}

RosterEntry Roster::Refuse(const JoinRequest& request, std::string reason, bool waiting) const {
  return {.session = request.session,
          .vehicle = request.wanted,
          .accepted = false,
          .waiting = waiting,
          .reason = std::move(reason),
          .epoch = epoch_,
          .fleet_size = fleet_size_};
}

}  // namespace giveway::sim

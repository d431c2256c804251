#include "sim_world/run/roster.h"

#include <algorithm>
#include <utility>

#include "services/types/check.h"

namespace giveway::sim {

Roster::Roster(const Scenario& scenario, WorldEpoch epoch)
    : epoch_(epoch),
      open_(IsOpen(scenario)),
      fleet_size_(open_ ? std::max(1U, scenario.start_with)
                        : static_cast<std::uint32_t>(scenario.vehicles.size())),
      named_(scenario.vehicles),
      spawns_(scenario.spawns) {
  for (const VehicleOptions& options : named_) seats_.push_back({.vehicle = options.id});
}

RosterEntry Roster::Admit(const JoinRequest& request, const SeatQuestions& ask) {
  if (const Seat* seat = SeatOf(request.session)) return Accept(*seat);
  if (request.wanted == kNobody) return AdmitAny(request, ask);
  if (Seat* seat = Find(request.wanted)) return AdmitTo(seat, request, ask);
  if (open_) return AdmitBySpawn(request.wanted, request, ask);
  return Refuse(request, "id " + std::to_string(Number(request.wanted)) + " is not in the scenario",
                false);
}

RosterEntry Roster::AdmitAny(const JoinRequest& request, const SeatQuestions& ask) {
  if (open_) return AdmitBySpawn(LowestFree(), request, ask);
  const auto can_have = [&](const Seat& seat) {
    return (!seat.taken || ask.is_silent(seat.vehicle)) && ask.is_free(OptionsOf(seat));
  };
  const auto seat = std::ranges::find_if(seats_, can_have);
  if (seat == seats_.end()) return Refuse(request, "the fleet is full", true);
  return AdmitTo(&*seat, request, ask);
}

RosterEntry Roster::AdmitTo(Seat* seat, const JoinRequest& request, const SeatQuestions& ask) {
  const std::string id = "id " + std::to_string(Number(seat->vehicle));
  if (seat->taken && !ask.is_silent(seat->vehicle)) {
    return Refuse(request, id + " is taken by another session", true);
  }
  if (!ask.is_free(OptionsOf(*seat))) {
    return Refuse(request, "the start place of " + id + " is not free", true);
  }
  seat->taken = true;
  seat->session = request.session;
  return Accept(*seat);
}

RosterEntry Roster::AdmitBySpawn(VehicleId vehicle, const JoinRequest& request,
                                 const SeatQuestions& ask) {
  if (seats_.size() >= kMaxSeats) return Refuse(request, "the fleet is full", true);
  for (std::uint32_t spawn = 1; spawn <= spawns_.size(); ++spawn) {
    const Seat seat{vehicle, spawn, true, request.session};
    if (IsPatrolled(spawn) || !ask.is_free(OptionsOf(seat))) continue;
    const auto at = std::ranges::lower_bound(seats_, vehicle, {}, &Seat::vehicle);
    return Accept(*seats_.insert(at, seat));
  }
  return Refuse(request, "no start place is free", true);
}

// A vehicle on a looping route returns to its start: another one must not start there.
bool Roster::IsPatrolled(std::uint32_t spawn) const {
  return spawns_[spawn - 1].route.loop &&
         std::ranges::find(seats_, spawn, &Seat::spawn) != seats_.end();
}

VehicleId Roster::LowestFree() const {
  std::uint32_t lowest = 1;
  for (const Seat& seat : seats_) {  // sorted; named ones are always there
    if (Number(seat.vehicle) == lowest) ++lowest;
  }
  return VehicleId{lowest};
}

void Roster::Free(VehicleId vehicle) {
  Seat* seat = Find(vehicle);
  if (seat == nullptr) return;
  if (IsNamed(vehicle)) {
    *seat = {.vehicle = vehicle};
  } else {
    seats_.erase(seats_.begin() + (seat - seats_.data()));
  }
}

const Seat* Roster::SeatOf(const SessionId& session) const {
  const auto has = [&](const Seat& seat) { return seat.taken && seat.session == session; };
  const auto seat = std::ranges::find_if(seats_, has);
  return seat == seats_.end() ? nullptr : &*seat;
}

Seat* Roster::Find(VehicleId vehicle) {
  const auto seat = std::ranges::lower_bound(seats_, vehicle, {}, &Seat::vehicle);
  return seat == seats_.end() || seat->vehicle != vehicle ? nullptr : &*seat;
}

bool Roster::IsNamed(VehicleId vehicle) const {
  return std::ranges::binary_search(named_, vehicle, {}, &VehicleOptions::id);
}

VehicleOptions Roster::OptionsOf(const Seat& seat) const {
  if (seat.spawn == 0) {
    return *std::ranges::lower_bound(named_, seat.vehicle, {}, &VehicleOptions::id);
  }
  VehicleOptions options = spawns_[seat.spawn - 1];
  options.id = seat.vehicle;
  return options;
}

bool Roster::Restore(std::span<const Seat> seats) {
  const auto fits = [&](const Seat& seat) {
    return seat.spawn == 0 ? IsNamed(seat.vehicle)
                           : seat.spawn <= spawns_.size() && !IsNamed(seat.vehicle);
  };
  if (!std::ranges::all_of(seats, fits)) return false;
  for (const Seat& seat : seats) {
    if (Seat* known = Find(seat.vehicle)) {
      *known = seat;
    } else {
      seats_.insert(std::ranges::lower_bound(seats_, seat.vehicle, {}, &Seat::vehicle), seat);
    }
  }
  return true;
}

RosterEntry Roster::Accept(const Seat& seat) const {
  return {.session = seat.session,
          .vehicle = seat.vehicle,
          .accepted = true,
          .epoch = epoch_,
          .start_world = OptionsOf(seat).start_world,
          .spawn = seat.spawn,
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

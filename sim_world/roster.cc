#include "sim_world/roster.h"

#include <algorithm>
#include <utility>

namespace giveway::sim {

Roster::Roster(const Scenario& scenario, WorldEpoch epoch) : epoch_(epoch) {
  for (const VehicleOptions& options : scenario.vehicles) {
    places_.push_back({.vehicle = options.id, .start_world = options.start_world});
  }
}

RosterEntry Roster::Admit(const JoinRequest& request) {
  for (const Place& place : places_) {
    if (place.taken && place.session == request.session) return Accept(place);
  }
  const auto free = [&](const Place& place) {
    return !place.taken && (request.wanted == kNobody || place.vehicle == request.wanted);
  };
  const auto place = std::ranges::find_if(places_, free);
  if (place != places_.end()) {
    place->taken = true;
    place->session = request.session;
    return Accept(*place);
  }
  if (request.wanted == kNobody) return Refuse(request, "the fleet is full");
  const std::string id = "id " + std::to_string(Number(request.wanted));
  if (std::ranges::find(places_, request.wanted, &Place::vehicle) == places_.end()) {
    return Refuse(request, id + " is not in the scenario");
  }
  return Refuse(request, id + " is taken by another session");
}

RosterEntry Roster::Accept(const Place& place) const {
  return {.session = place.session,
          .vehicle = place.vehicle,
          .accepted = true,
          .epoch = epoch_,
          .start_world = place.start_world,
          .fleet_size = static_cast<std::uint32_t>(places_.size())};
}

RosterEntry Roster::Refuse(const JoinRequest& request, std::string reason) const {
  return {.session = request.session,
          .vehicle = request.wanted,
          .accepted = false,
          .reason = std::move(reason),
          .epoch = epoch_,
          .fleet_size = static_cast<std::uint32_t>(places_.size())};
}

}  // namespace giveway::sim

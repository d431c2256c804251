// Who may be which vehicle: answers join requests from the scenario's list of vehicles. An id given
// to a session stays with it for the whole run.
#pragma once

#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"

namespace giveway::sim {

class Roster {
 public:
  Roster(const Scenario& scenario, WorldEpoch epoch);

  // Accepted with id and start pose, or refused with a reason. A session that was accepted gets the
  // same answer however often and for whatever id it asks again. run_state is the caller's to set.
  RosterEntry Admit(const JoinRequest& request);

 private:
  struct Place {
    VehicleId vehicle = kNobody;
    Pose start_world;
    bool taken = false;
    SessionId session{};
  };

  RosterEntry Accept(const Place& place) const;
  RosterEntry Refuse(const JoinRequest& request, std::string reason) const;

  WorldEpoch epoch_;
  std::vector<Place> places_;  // sorted by id
};

}  // namespace giveway::sim

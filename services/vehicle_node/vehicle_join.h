// How a vehicle gets its place: asks the world, again and again, and hears its answer.
#pragma once

#include <optional>
#include <string>

#include "services/link/vehicle_link.h"
#include "services/runtime/process.h"
#include "services/types/scenario.h"
#include "services/vehicle_node/vehicle_health.h"

namespace giveway {

// One request until it is answered for good. Talks over a link that outlives it.
class Asking {
 public:
  // With a session of its own, or the one that a restarted process had before.
  Asking(link::VehicleLink* link, VehicleId wanted,
         const std::optional<SessionId>& session = std::nullopt);

  const SessionId& Session() const { return request_.session; }
  bool Answered() const { return answered_; }
  // The world's reason to let it wait; empty before it gave one.
  const std::string& WaitsFor() const { return waits_for_; }

  void AskAgainIfDue();
  // True if this is the last word on the request; a reason to wait is only logged.
  bool IsFinal(const RosterEntry& entry);

 private:
  void Ask();

  link::VehicleLink& link_;
  JoinRequest request_;
  SteadyTime again_{0};
  bool answered_ = false;
  std::string waits_for_;
};

// By what the vehicle of this entry drives, from where it was put. Throws LinkError where the world
// has another scenario.
VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry);

// Waits for the last word. Empty if asked to stop meanwhile.
std::optional<RosterEntry> Join(link::VehicleLink* link, const StopSignal& stop, VehicleId wanted,
                                const std::optional<SessionId>& session,
                                VehicleHealthTeller* health);

}  // namespace giveway

// How a vehicle asks its world for a place: again and again, until it has the last word.
#pragma once

#include <optional>
#include <string>

#include "services/link/drive_link.h"
#include "services/runtime/clock.h"

namespace giveway {

// One request until its final answer. Talks over a link that outlives it.
class Asking {
 public:
  // With a session of its own, or the one that a restarted process had before.
  Asking(link::DriveLink* link, const Clock* clock, VehicleId wanted,
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

  link::DriveLink& link_;
  const Clock& clock_;
  JoinRequest request_;
  SteadyTime again_{0};
  bool answered_ = false;
  std::string waits_for_;
};

}  // namespace giveway

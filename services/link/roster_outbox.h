// What the world said to each session, kept for latecomers; and disposed when the session is over,
// so that a run in which thousands come and go does not send all of them to each newcomer.
#pragma once

#include <deque>
#include <unordered_map>

#include "services/link/fastdds/endpoint.h"
#include "services/types/fleet_facts.h"

namespace giveway::link {

class RosterOutbox {
 public:
  explicit RosterOutbox(Writer<wire::Roster> writer) : writer_(writer) {}

  // False if the library refused the entry.
  bool Send(const RosterEntry& entry);
  // The vehicle's session is over.
  void Retire(VehicleId vehicle);
  bool WaitUntilHeard(std::chrono::steady_clock::time_point until) {
    return writer_.WaitUntilHeard(until);
  }

 private:
  void Retire(const SessionId& session);
  void NoteAccepted(VehicleId vehicle, const SessionId& session);
  void NoteRefused(const SessionId& session);

  Writer<wire::Roster> writer_;
  std::unordered_map<VehicleId, SessionId> accepted_;
  std::deque<SessionId> refused_;  // still published, oldest first
};

}  // namespace giveway::link

#include "services/link/roster_outbox.h"

#include <algorithm>

#include "services/link/convert/convert.h"

namespace giveway::link {
namespace {

constexpr std::size_t kRefusalsKept = 64;  // more than ask within the time one takes to arrive

}  // namespace

bool RosterOutbox::Send(const RosterEntry& entry) {
  if (entry.accepted) {
    NoteAccepted(entry.vehicle, entry.session);
  } else {
    NoteRefused(entry.session);
  }
  return writer_.Write(ToWire(entry));
}

void RosterOutbox::Retire(VehicleId vehicle) {
  const auto held = accepted_.find(vehicle);
  if (held == accepted_.end()) return;
  Retire(held->second);
  accepted_.erase(held);
}

void RosterOutbox::Retire(const SessionId& session) {
  wire::Roster entry;
  entry.session(session);
  writer_.Retire(entry);
}

void RosterOutbox::NoteAccepted(VehicleId vehicle, const SessionId& session) {
  std::erase(refused_, session);
  const auto held = accepted_.find(vehicle);
  if (held != accepted_.end() && held->second != session) Retire(held->second);
  accepted_[vehicle] = session;
}

void RosterOutbox::NoteRefused(const SessionId& session) {
  if (std::find(refused_.begin(), refused_.end(), session) != refused_.end()) return;
  refused_.push_back(session);
  if (refused_.size() <= kRefusalsKept) return;
  Retire(refused_.front());
  refused_.pop_front();
}

}  // namespace giveway::link

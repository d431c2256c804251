#include "services/link/peer_events.h"

#include <utility>

namespace giveway::link {
PeerEvents::PeerEvents(const WriterNames& names, const rtps::GuidPrefix_t& own)
    : names_(names), own_(own) {}

void PeerEvents::Matched(VehicleId vehicle) {
  ++matched_writers_;
  if (vehicle != kNobody) ++peers_[vehicle].writers;
}

void PeerEvents::Unmatched(VehicleId vehicle) {
  if (matched_writers_ > 0) --matched_writers_;
  const auto peer = peers_.find(vehicle);
  if (peer != peers_.end() && --peer->second.writers == 0) peers_.erase(peer);
}

bool PeerEvents::IsNewMiss(VehicleId vehicle) {
  const auto peer = peers_.find(vehicle);
  return peer != peers_.end() && !std::exchange(peer->second.missed, true);
}

void PeerEvents::Heard(VehicleId vehicle) {
  const auto peer = peers_.find(vehicle);
  if (peer != peers_.end()) peer->second.missed = false;
}

void PeerEvents::Translate(std::span<const ReaderEvent> events, SteadyTime now,
                           std::vector<QosEvent>& told) {
  for (const ReaderEvent& event : events) {
    if (event.kind == ReaderEvent::Kind::kIncompatibleQos) {
      told.push_back({QosEventKind::kIncompatibleQos, kNobody, now});
      continue;
    }
    if (event.kind == ReaderEvent::Kind::kDeadlineMissed) {
      const VehicleId vehicle{KeyOf(event.handle)};
      if (IsNewMiss(vehicle)) told.push_back({QosEventKind::kDeadlineMissed, vehicle, now});
      continue;
    }
    const rtps::GUID_t writer = GuidOf(event.handle);
    if (writer.guidPrefix == own_) continue;
    const WriterEntry* const entry = names_.Find(writer);
    const VehicleId vehicle = entry == nullptr ? kNobody : entry->vehicle;
    switch (event.kind) {
      case ReaderEvent::Kind::kMatched:
        Matched(vehicle);
        told.push_back({QosEventKind::kMatched, vehicle, now});
        break;
      case ReaderEvent::Kind::kUnmatched:
        Unmatched(vehicle);
        not_alive_.erase(Identity(writer));
        told.push_back({QosEventKind::kUnmatched, vehicle, now});
        break;
      case ReaderEvent::Kind::kNotAlive:
        not_alive_.insert(Identity(writer));
        told.push_back({QosEventKind::kLivelinessLost, vehicle, now});
        break;
      case ReaderEvent::Kind::kAlive:
        // The first sample of a writer is no return.
        if (not_alive_.erase(Identity(writer)) > 0) {
          told.push_back({QosEventKind::kLivelinessBack, vehicle, now});
        }
        break;
      default:
        break;
    }
  }
}

}  // namespace giveway::link

#include "services/link/peer_events.h"

#include <utility>

namespace giveway::link {

PeerEvents::PeerEvents(const WriterNames& names, const rtps::GuidPrefix_t& own, std::string area)
    : names_(names), own_(own), area_(std::move(area)) {}

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

VehicleId PeerEvents::Unfit(const ReaderEvent& event) {
  if (area_.empty()) return kNobody;
  const WriterEntry* unfit = names_.Find(GuidOf(event.handle));
  if (unfit == nullptr || !MayBeUnfit(*unfit)) unfit = NewestUnmatched();
  std::erase_if(unfit_, [this](std::uint64_t writer) { return names_.Find(writer) == nullptr; });
  if (unfit == nullptr) return kNobody;
  unfit_.insert(unfit->identity);
  return unfit->vehicle;
}

bool PeerEvents::MayBeUnfit(const WriterEntry& writer) const {
  return writer.area == area_ && !matched_.contains(writer.identity);
}

const WriterEntry* PeerEvents::NewestUnmatched() const {
  const WriterEntry* newest = nullptr;
  names_.ForEach([&](const WriterEntry& entry) {
    if (!MayBeUnfit(entry) || unfit_.contains(entry.identity)) return;
    if (newest == nullptr || entry.found > newest->found) newest = &entry;
  });
  return newest;
}

void PeerEvents::NoteMatch(const ReaderEvent& event) {
  const std::uint64_t writer = Identity(GuidOf(event.handle));
  if (event.kind == ReaderEvent::Kind::kMatched) {
    matched_.insert(writer);
    unfit_.erase(writer);
  } else if (event.kind == ReaderEvent::Kind::kUnmatched) {
    matched_.erase(writer);
  }
}

void PeerEvents::Translate(std::span<const ReaderEvent> events, SteadyTime now,
                           std::vector<QosEvent>& told) {
  // All matches first: who is matched a moment later is not the one that does not fit.
  for (const ReaderEvent& event : events) NoteMatch(event);
  for (const ReaderEvent& event : events) {
    if (event.kind == ReaderEvent::Kind::kIncompatibleQos) {
      told.push_back({QosEventKind::kIncompatibleQos, Unfit(event), now});
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

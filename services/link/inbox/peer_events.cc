#include "services/link/inbox/peer_events.h"

#include <utility>

namespace giveway::link {

PeerEvents::PeerEvents(const WriterNames& names, const rtps::GuidPrefix_t& own, std::string area)
    : names_(names), own_(own), area_(std::move(area)) {}

void PeerEvents::Match(const rtps::GUID_t& writer) {
  if (writer.guidPrefix == own_) return;
  const WriterEntry* const entry = names_.Find(writer);
  const VehicleId vehicle = entry == nullptr ? kNoVehicle : entry->vehicle;
  if (!writers_.try_emplace(Identity(writer), Writer{.vehicle = vehicle}).second) return;
  if (vehicle != kNoVehicle) ++peers_[vehicle].writers;
  Emit(QosEventKind::kMatched, vehicle);
}

void PeerEvents::Unmatch(std::uint64_t writer) {
  const auto found = writers_.find(writer);
  if (found == writers_.end()) return;
  const VehicleId vehicle = found->second.vehicle;
  writers_.erase(found);
  const auto peer = peers_.find(vehicle);
  if (peer != peers_.end() && --peer->second.writers == 0) peers_.erase(peer);
  Emit(QosEventKind::kUnmatched, vehicle);
}

// The first sample of a writer is no return.
void PeerEvents::SetSilent(std::uint64_t writer, bool silent) {
  const auto found = writers_.find(writer);
  if (found == writers_.end() || std::exchange(found->second.silent, silent) == silent) return;
  Emit(silent ? QosEventKind::kLivelinessLost : QosEventKind::kLivelinessBack,
       found->second.vehicle);
}

void PeerEvents::Miss(VehicleId vehicle, Peer* peer) {
  if (!std::exchange(peer->missed, true)) Emit(QosEventKind::kDeadlineMissed, vehicle);
}

void PeerEvents::Heard(VehicleId vehicle, SteadyTime now) {
  const auto peer = peers_.find(vehicle);
  if (peer == peers_.end()) return;
  peer->second.missed = false;
  peer->second.heard = now;
}

void PeerEvents::Watch(SteadyTime now, Nanoseconds deadline, std::vector<QosEvent>& events) {
  now_ = now;
  events_ = &events;
  for (auto& [vehicle, peer] : peers_) {
    if (peer.heard && now - *peer.heard > deadline) Miss(vehicle, &peer);
  }
}

VehicleId PeerEvents::Unfit(const ReaderEvent& event) {
  if (area_.empty()) return kNoVehicle;
  const WriterEntry* unfit = names_.Find(GuidOf(event.handle));
  if (unfit == nullptr || !MayBeUnfit(*unfit)) unfit = NewestUnmatched();
  std::erase_if(unfit_, [this](std::uint64_t writer) { return names_.Find(writer) == nullptr; });
  if (unfit == nullptr) return kNoVehicle;
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

void PeerEvents::Translate(const ReaderNews& news, SteadyTime now, std::vector<QosEvent>& events) {
  now_ = now;
  events_ = &events;
  // All matches first: a writer that is matched a moment later is not the one that does not fit.
  for (const ReaderEvent& event : news.events) NoteMatch(event);
  for (const ReaderEvent& event : news.events) Follow(event);
  if (news.incomplete) Reconcile(news.matched);
}

void PeerEvents::Follow(const ReaderEvent& event) {
  const auto writer = [&] { return Identity(GuidOf(event.handle)); };
  switch (event.kind) {
    case ReaderEvent::Kind::kDeadlineMissed: {
      const auto peer = peers_.find(VehicleId{KeyOf(event.handle)});
      if (peer != peers_.end()) Miss(peer->first, &peer->second);
      break;
    }
    case ReaderEvent::Kind::kIncompatibleQos:
      Emit(QosEventKind::kIncompatibleQos, Unfit(event));
      break;
    case ReaderEvent::Kind::kMatched:
      Match(GuidOf(event.handle));
      break;
    case ReaderEvent::Kind::kUnmatched:
      Unmatch(writer());
      break;
    case ReaderEvent::Kind::kNotAlive:
      SetSilent(writer(), true);
      break;
    case ReaderEvent::Kind::kAlive:
      SetSilent(writer(), false);
      break;
  }
}

// After events were dropped: what is matched now counts, and each difference is reported.
void PeerEvents::Reconcile(std::span<const MatchedWriter> matched) {
  matched_.clear();
  for (const MatchedWriter& writer : matched) matched_.insert(Identity(GuidOf(writer.handle)));
  std::vector<std::uint64_t> gone;
  for (const auto& [identity, writer] : writers_) {
    if (!matched_.contains(identity)) gone.push_back(identity);
  }
  for (const std::uint64_t writer : gone) Unmatch(writer);
  for (const MatchedWriter& writer : matched) {
    unfit_.erase(Identity(GuidOf(writer.handle)));
    Match(GuidOf(writer.handle));
    SetSilent(Identity(GuidOf(writer.handle)), !writer.alive);
  }
}

}  // namespace giveway::link

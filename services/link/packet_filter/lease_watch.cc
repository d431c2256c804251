#include "services/link/packet_filter/lease_watch.h"

#include <algorithm>

namespace giveway::link {

bool LeaseWatch::Hear(Bytes packet, SteadyTime now) {
  const PrefixBytes sender = SenderOf(packet);
  const auto known = participants_.find(sender);
  if (known != participants_.end()) known->second.heard = now;
  bool announces = false;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (!IsAnnouncement(part)) continue;
    announces = true;
    Note(sender, part, now);
  }
  return announces;
}

void LeaseWatch::Note(const PrefixBytes& sender, const Submessage& announcement, SteadyTime now) {
  const auto participant = AnnouncedParticipant(announcement);
  const auto lease = AnnouncedLease(announcement);
  if (!participant.has_value() || !lease.has_value()) {
    participants_.erase(sender);
    return;
  }
  if (*participant != sender) return;  // a discovery server speaks for it
  if (!participants_.contains(sender)) MakeRoom();
  // As the library will hear it: the packet is shortened behind this watch.
  const Nanoseconds shortened = std::min<Nanoseconds>(*lease, kLongestLease);
  participants_[sender] = {now, shortened, AnnouncementNumber(announcement)};
}

void LeaseWatch::MakeRoom() {
  if (participants_.size() < kMostParticipants) return;
  participants_.erase(std::ranges::min_element(
      participants_, {}, [](const auto& participant) { return participant.second.heard; }));
}

std::optional<Farewell> LeaseWatch::TakeFarewell(SteadyTime now) {
  const auto lapsed = std::ranges::find_if(participants_, [now](const auto& participant) {
    const Announced& announced = participant.second;
    return now - announced.heard >= announced.lease / 10 * 9;
  });
  if (lapsed == participants_.end()) return std::nullopt;
  const Farewell farewell = FarewellOf(lapsed->first, lapsed->second.number + 1);
  participants_.erase(lapsed);
  return farewell;
}

}  // namespace giveway::link

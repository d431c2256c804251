// Which participants have been silent for nearly the lease that they announced, and the farewell
// that they did not send. The library keeps a record of every writer whose participant it drops for
// its lease, some 370 bytes a killed process, and never frees it; of a participant that sends a
// farewell it keeps nothing. So a farewell is sent in the name of a dead participant, just before
// its lease ends. Pure: no sockets, no clock, no lock.
//
// For participants found by their own announcements. A discovery server ends the leases of its own
// clients, and reports that to the others.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "services/link/packet_filter/announcement.h"
#include "services/link/packet_filter/rtps_bytes.h"
#include "services/types/time.h"

namespace giveway::link {

class LeaseWatch {
 public:
  // Beyond, the one that was silent longest is forgotten: then the library ends its lease.
  static constexpr std::size_t kMostParticipants = 1024;

  // A packet of which all submessages are sound. True if it announces its sender, or ends it.
  bool Hear(Bytes packet, SteadyTime now);

  // The farewell of one participant whose silence has lasted nine tenths of its lease: a packet as
  // it would have sent it, once. Nothing if all were heard.
  std::optional<Farewell> TakeFarewell(SteadyTime now);

  std::size_t Participants() const { return participants_.size(); }

 private:
  struct Announced {
    SteadyTime heard{0};
    Nanoseconds lease{0};
    std::int64_t number = 0;  // of its newest announcement
  };
  void Note(const PrefixBytes& sender, const Submessage& announcement, SteadyTime now);
  void MakeRoom();

  std::unordered_map<PrefixBytes, Announced, PrefixHash> participants_;
};

}  // namespace giveway::link

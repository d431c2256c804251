// Which of the packets that reach a process its DDS library may see. Fast DDS believes what
// arrives: one packet can end it, fill its memory, or keep it busy for hours. What a sound sender
// never sends is dropped here, counted by reason, before the library reads it. Pure: no sockets, no
// clock, no lock.
//
// It takes no part in trust: identity and contents of a sample are judged where samples are taken.
// A packet that is sound, of a plausible sequence number and a forged GUID passes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "services/link/packet_filter/discovery_order.h"
#include "services/link/packet_filter/packet_context.h"
#include "services/link/packet_filter/participant_table.h"
#include "services/link/packet_filter/rtps_bytes.h"
#include "services/link/packet_filter/writer_table.h"
#include "services/types/figures/packet_counters.h"
#include "services/types/time.h"

namespace giveway::link {

struct PacketFilterOptions {
  std::uint32_t largest_sample = 65536;  // bytes of the largest type
  std::uint32_t fleet_size = 2;          // decides how many writers are remembered
  std::uint32_t strangers = 256;         // new participants at once, in addition to two a vehicle
  std::size_t writers = 0;               // to remember, at least; 0: as fleet_size decides
  bool loopback_only = false;            // hears 127.0.0.0/8 and nothing else
  bool secured = false;                  // DDS-Security is on: its submessages pass
  bool of_all_bodies = false;            // hears of every body of the fleet: of an observer
  std::uint64_t seed = 0;                // from the operating system: strangers must not know it
};

struct PacketVerdict {
  PacketDrop drop = PacketDrop::kNone;
  // Of a packet that is handed on: so many bytes of it. The library's own statistics submessage,
  // which ends each packet it sends, is left out: reading it can end a process.
  std::size_t bytes = 0;
  bool announces = false;      // it holds what discovery says: see HideTypes
  bool has_long_gaps = false;  // more than the library may step through: see ShortenGaps
  bool has_fragments = false;  // none of which the library may see: see FragmentStore
};

class PacketFilter {
 public:
  explicit PacketFilter(const PacketFilterOptions& options);

  // `source`: the sender's IPv4 address, first octet highest. Calls come in the order of `now`, or
  // nearly.
  PacketVerdict Check(Bytes packet, std::uint32_t source, SteadyTime now);
  // Of a farewell that the library is given in the name of a dead participant.
  void EndParticipants(Bytes packet);
  const ParticipantTable& Participants() const { return participants_; }
  // A packet that this process sends, where AcknowledgesDiscovery says so.
  void HearOwn(Bytes sent) { order_.HearOwn(sent); }
  // Its parts refer to each other.
  PacketFilter(const PacketFilter&) = delete;
  PacketFilter& operator=(const PacketFilter&) = delete;

 private:
  PacketVerdict CheckParts(Bytes packet) const;
  PacketDrop CheckWriters(Bytes packet, SteadyTime now);
  PacketDrop CheckWriter(const Submessage& submessage, const PacketContext& context,
                         SteadyTime now);
  bool IsNextCount(const Submessage& submessage, const std::uint8_t* prefix, SteadyTime now);
  PacketDrop CheckAnnouncement(const Submessage& announcement, const PacketContext& context,
                               SteadyTime now);
  bool MayAdd(const Submessage& of_discovery, SteadyTime now);

  PacketFilterOptions options_;
  WriterTable writers_;
  ParticipantTable participants_;
  DiscoveryOrder order_{participants_};
};

}  // namespace giveway::link

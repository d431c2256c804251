// How many participants a process may get to know, and how many endpoints of each: the library
// keeps a record of every one that is announced, and limits neither. Bounded; pure: no sockets, no
// clock, no lock.
//
// The participants are no entries of writer_table.h: there any DATA makes one, and a stranger would
// be known before it announces itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <unordered_map>

#include "services/link/packet_filter/announcement.h"
#include "services/link/packet_filter/arrival_window.h"
#include "services/link/packet_filter/token_bucket.h"
#include "services/types/time.h"

namespace giveway::link {

class ParticipantTable {
 public:
  // New participants after the first ones. Of strangers that fall silent the library so knows 480,
  // those of kLongestLease, and the first ones at most.
  static constexpr std::int64_t kStrangersPerSecond = 4;
  // Each participant may have so many endpoints; a vehicle has 15. What one has beyond is taken
  // from what all have in common: a world has five for each vehicle, and after a restart as many
  // again.
  static constexpr std::size_t kOwnEndpoints = 32;
  static constexpr std::int64_t kCommonEndpointsAVehicle = 16;
  static constexpr std::int64_t kCommonEndpointsAStranger = 8;
  static constexpr std::int64_t kEndpointsPerSecond = 4;  // in common, after the first ones
  // Of one participant. Beyond, all of its endpoints are new again.
  static constexpr std::size_t kMostEndpointsKept = 4096;

  // `strangers`: new participants at once, in addition to two a vehicle.
  ParticipantTable(std::uint32_t strangers, std::uint32_t fleet_size);

  // Whether a participant may announce itself: it is known, or one more may be.
  bool MayJoin(const PrefixBytes& participant, SteadyTime now);
  // A farewell that was handed on: the participant is a stranger until it announces itself again,
  // and its writers start where the library, which meets it as new, expects them. It stays in
  // the table: after a forged farewell its return takes no turn of the strangers'.
  void End(const PrefixBytes& participant);
  // Whether a participant may announce this endpoint: it is known, or one more may be. Of a
  // participant that is not known the library knows no endpoint.
  bool MayAdd(const EndpointGuid& endpoint, SteadyTime now);
  // One has ended: a world makes new ones for each vehicle that comes, for weeks. Who forges such
  // ends for each of its endpoints gets past the limit.
  void Remove(const EndpointGuid& endpoint);

  // Of a participant that is known, and of one of its discovery writers: discovery_order.h. Null if
  // it is not known. Valid until another one joins.
  static constexpr std::size_t kOrderedWriters = 3;
  ArrivalWindow* WindowOf(const PrefixBytes& participant, std::size_t writer);

  bool Knows(const PrefixBytes& participant) const { return participants_.contains(participant); }
  std::size_t Participants() const { return participants_.size(); }

 private:
  struct Participant {
    std::uint32_t announcements = 0;
    SteadyTime heard{0};
    std::set<std::uint32_t> endpoints;
    std::array<ArrivalWindow, kOrderedWriters> windows;
  };
  void MakeRoom(SteadyTime now);

  std::size_t most_participants_;
  TokenBucket new_participants_;
  TokenBucket common_endpoints_;
  std::unordered_map<PrefixBytes, Participant, PrefixHash> participants_;
};

}  // namespace giveway::link

// In which order the samples of a participant's reliable discovery writers reach the library: those
// of its publications, its subscriptions and its assertions of liveliness. Their readers keep what
// lies beyond a hole without limit; of assertions also one for each key.
//
// Where the library stands it says itself, each time it acknowledges. Bounded: for participants
// that participant_table.h knows. Pure: no sockets, no clock, no lock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "services/link/packet_filter/packet_context.h"
#include "services/link/packet_filter/participant_table.h"
#include "services/link/packet_filter/rtps_bytes.h"
#include "services/link/packet_filter/token_bucket.h"
#include "services/types/figures/packet_counters.h"
#include "services/types/time.h"

namespace giveway::link {

// Whether it is of one of these writers: DATA, DATA_FRAG, HEARTBEAT or GAP, sound by itself.
bool IsOfDiscoveryOrder(const Submessage& submessage);
// Whether a packet that this process sends acknowledges samples of such a writer.
bool AcknowledgesDiscovery(Bytes sent);

class DiscoveryOrder {
 public:
  // Assertions are a prefix, a kind and a few bytes.
  static constexpr std::size_t kMostAsserted = 128;  // bytes, with the encapsulation

  // `participants` outlives this.
  explicit DiscoveryOrder(ParticipantTable& participants);

  // A packet that is handed on unless this finds a reason: then nothing of it is noted.
  PacketDrop Check(Bytes packet, SteadyTime now);
  // One that this process sends, and that acknowledges.
  void HearOwn(Bytes sent);

 private:
  PacketDrop CheckPart(const Submessage& part, const PacketContext& context, SteadyTime now);
  ArrivalWindow* Touch(const PrefixBytes& participant, std::size_t writer);
  bool IsForOthers(const PacketContext& context) const;

  ParticipantTable& participants_;
  std::optional<PrefixBytes> own_;  // once it was heard
  // Of participants that are not known: the library mostly does not know them either.
  TokenBucket of_unknown_;
  // Those of this packet: where they are kept, and what becomes of them if it is handed on.
  std::vector<std::pair<ArrivalWindow*, ArrivalWindow>> touched_;
};

}  // namespace giveway::link

// How often a participant that does not answer is asked what its writers hold. Fast DDS 2.9.1 asks
// each reliable writer of discovery 14 times a second until one HEARTBEAT comes: 256 announced
// participants that are not there took a fifth of a processor in each process of a fleet until
// their leases were over. From 2.9.2 on it doubles the interval each time (eProsima/Fast-DDS#3419).
// Here the interval grows by a quarter of the time that a participant has been asked for, up to a
// second: one that was cut off is met within a second of its return. Pure: no sockets, no clock, no
// lock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "services/link/packet_filter/announcement.h"
#include "services/link/packet_filter/rtps_bytes.h"
#include "services/types/time.h"

namespace giveway::link {

// The participant that a packet of this process asks, where that is all that the packet does: an
// ACKNACK of number 0, to one destination.
std::optional<PrefixBytes> AskedParticipant(Bytes sent);

class AskPace {
 public:
  // Beyond, the one that was asked for the longest time is as one never asked.
  static constexpr std::size_t kMostAsked = 1024;

  // Whether that participant may be asked now. All its writers are asked in one turn.
  bool MayAsk(const PrefixBytes& participant, SteadyTime now);
  // A sound packet that arrived: of its sender there is nothing to ask if an endpoint sent it.
  void Hear(Bytes packet);

  std::size_t Asked() const { return asked_.size(); }

 private:
  struct Turn {
    SteadyTime first{0};  // when it was asked for the first time
    SteadyTime end{0};    // of this turn
    SteadyTime next{0};   // when the next one starts
  };
  void MakeRoom();

  std::unordered_map<PrefixBytes, Turn, PrefixHash> asked_;
};

}  // namespace giveway::link

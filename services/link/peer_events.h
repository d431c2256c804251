// Turns what a reader's listener queued into QoS events that name a vehicle, and keeps who is
// matched. A deadline miss becomes an edge: once a vehicle until it is heard again, and never for a
// vehicle that has left, because the library repeats misses of departed instances for ever.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "services/link/reader_events.h"
#include "services/link/writer_names.h"
#include "services/types/qos_event.h"

namespace giveway::link {

class PeerEvents {
 public:
  // Of a reader of the beacons of `area`, or of another topic where it is empty. Nothing is told of
  // writers with the prefix `own`: a reader matches its own participant's.
  PeerEvents(const WriterNames& names, const rtps::GuidPrefix_t& own, std::string area);

  // Appends to `told`. `names` must be updated after `events` were taken.
  void Translate(std::span<const ReaderEvent> events, SteadyTime now, std::vector<QosEvent>& told);
  // A sample of the vehicle was accepted: its next deadline miss is news again.
  void Heard(VehicleId vehicle);

  // Writers matched now, own excluded.
  std::uint32_t MatchedWriters() const { return matched_writers_; }
  bool IsMatched(VehicleId vehicle) const { return peers_.contains(vehicle); }

 private:
  struct Peer {
    std::uint32_t writers = 0;  // matched; more than one where an id is claimed twice
    bool missed = false;
  };

  void NoteMatch(const ReaderEvent& event);
  void Matched(VehicleId vehicle);
  void Unmatched(VehicleId vehicle);
  bool IsNewMiss(VehicleId vehicle);
  // Whom the writer that an event of incompatible QoS is about belongs to: the one it names. If
  // that one cannot be meant, the newest that can and was not told of before; else kNobody.
  VehicleId Unfit(const ReaderEvent& event);
  // Whether it speaks in the area and is not matched.
  bool MayBeUnfit(const WriterEntry& writer) const;
  const WriterEntry* NewestUnmatched() const;

  const WriterNames& names_;
  rtps::GuidPrefix_t own_;
  const std::string area_;
  std::uint32_t matched_writers_ = 0;
  std::unordered_map<VehicleId, Peer> peers_;    // with at least one matched writer
  std::unordered_set<std::uint64_t> not_alive_;  // matched writers that fell silent, by identity
  std::unordered_set<std::uint64_t> matched_;    // own included
  std::unordered_set<std::uint64_t> unfit_;      // told to be incompatible
};

}  // namespace giveway::link

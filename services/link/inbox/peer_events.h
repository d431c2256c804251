// Turns what a reader's listener queued into QoS events that name a vehicle, and keeps which
// vehicles are matched. A deadline miss becomes an edge: once a vehicle until its next sample, and
// never for a vehicle that has left, because the library repeats misses of departed instances for
// ever. This side's own clock watches each peer's deadline in addition to the library, which may
// stop watching.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "services/link/fastdds/reader_events.h"
#include "services/link/fastdds/writer_names.h"
#include "services/types/qos_event.h"
#include "services/types/time.h"

namespace giveway::link {

class PeerEvents {
 public:
  // Of a reader of the beacons of `area`, or of another topic where it is empty. Writers with the
  // prefix `own` are not reported: a reader matches its own participant's.
  PeerEvents(const WriterNames& names, const rtps::GuidPrefix_t& own, std::string area);

  // Appends to `events`. `names` must be updated after `news` was taken.
  void Translate(const ReaderNews& news, SteadyTime now, std::vector<QosEvent>& events);
  // A sample of the vehicle was accepted: its next deadline miss is news again.
  void Heard(VehicleId vehicle, SteadyTime now);
  // Reports peers without an accepted sample for longer than `deadline`, unless the library did.
  // Like the library's, the watch starts with the first sample. After a drain.
  void Watch(SteadyTime now, Nanoseconds deadline, std::vector<QosEvent>& events);

  // Writers matched now, own excluded.
  std::uint32_t MatchedWriters() const { return static_cast<std::uint32_t>(writers_.size()); }
  bool IsMatched(VehicleId vehicle) const { return peers_.contains(vehicle); }

 private:
  struct Writer {
    VehicleId vehicle = kNoVehicle;
    bool silent = false;  // its liveliness is lost
  };
  struct Peer {
    std::uint32_t writers = 0;  // matched; more than one where an id is claimed twice
    bool missed = false;
    std::optional<SteadyTime> heard;  // last
  };

  void NoteMatch(const ReaderEvent& event);
  void Follow(const ReaderEvent& event);
  void Reconcile(std::span<const MatchedWriter> matched);
  // Each has no effect where it is known already.
  void Match(const rtps::GUID_t& writer);
  void Unmatch(std::uint64_t writer);
  void SetSilent(std::uint64_t writer, bool silent);
  void Miss(VehicleId vehicle, Peer* peer);
  void Emit(QosEventKind kind, VehicleId vehicle) { events_->push_back({kind, vehicle, now_}); }
  // The vehicle that an event of incompatible QoS is about: that of the writer it names. If that
  // one is not possible, the newest that is and was not reported before; else kNoVehicle.
  VehicleId Unfit(const ReaderEvent& event);
  // Whether it speaks in the area and is not matched.
  bool MayBeUnfit(const WriterEntry& writer) const;
  const WriterEntry* NewestUnmatched() const;

  const WriterNames& names_;
  rtps::GuidPrefix_t own_;
  const std::string area_;
  std::unordered_map<std::uint64_t, Writer> writers_;  // matched, own excluded, by identity
  std::unordered_map<VehicleId, Peer> peers_;          // with at least one matched writer
  std::unordered_set<std::uint64_t> matched_;          // own included
  std::unordered_set<std::uint64_t> unfit_;            // reported as incompatible
  SteadyTime now_{0};                                  // of the current call, as the next
  std::vector<QosEvent>* events_ = nullptr;
};

}  // namespace giveway::link

// Drains the beacon reader: converts, checks the sum and the name, and leaves judging to the brain.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/anchored_reader.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/inbox/arrival_log.h"
#include "services/types/beacon.h"
#include "services/types/qos_event.h"
#include "services/types/refusal.h"

namespace giveway::link {

class BeaconInbox {
 public:
  // Beacons of writers with the prefix `own` are left out: a reader hears its own participant. Of a
  // reader with a deadline its listener must remove departed vehicles: ReaderEvents with
  // RemoveDeparted. `arrivals` is of
  // the reader's filter and outlives this; without it beacons say nothing of their arrival.
  BeaconInbox(Reader<wire::Beacon> reader, WriterNames& names, const rtps::GuidPrefix_t& own,
              ArrivalLog* arrivals = nullptr);

  // Appends the new beacons, stamped with `now`, and to `lost`, if given, the vehicles whose
  // samples are missing: once for each gap. `names` must be updated first.
  void Drain(SteadyTime now, std::vector<ReceivedBeacon>& beacons,
             std::vector<QosEvent>* lost = nullptr);

  // The longest latency of those that the last Drain took.
  std::optional<Nanoseconds> LongestLatency() const { return longest_latency_; }
  // Samples overwritten in the reader before they were drained: gaps in the writers' sequence
  // numbers less those the library reports as lost in transit.
  std::uint32_t Superseded();
  std::uint32_t Unbound() const { return unbound_; }  // writer not known: dropped
  // The first few that the last Drain refused, or found broken or misnamed.
  const std::vector<Refusal>& Refused() const { return refused_; }
  std::uint32_t Unreadable() const { return unreadable_; }  // unknown enumerator: dropped

 private:
  void Receive(const wire::Beacon& sample, const dds::SampleInfo& info, SteadyTime now,
               std::vector<ReceivedBeacon>& beacons, std::vector<QosEvent>* lost);
  BeaconArrival ArrivalOf(const WriterEntry& entry, std::uint64_t sequence);
  void NoteRefusal(const wire::Beacon& sample, const WriterEntry& entry,
                   const ReceivedBeacon& received, const Arrival& arrival);

  AnchoredReader<wire::Beacon> reader_;
  WriterNames& names_;
  rtps::GuidPrefix_t own_;
  ArrivalLog* arrivals_;
  std::uint64_t gaps_ = 0;
  std::uint32_t superseded_ = 0;
  std::uint32_t unbound_ = 0;
  std::uint32_t unreadable_ = 0;
  std::vector<Refusal> refused_;
  std::optional<Nanoseconds> longest_latency_;
};

}  // namespace giveway::link

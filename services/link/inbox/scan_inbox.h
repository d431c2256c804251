// The scans of one sensor of one vehicle, of which only the newest is wanted. One writer, so
// statuses are polled.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/endpoint.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/inbox/latency.h"
#include "services/link/inbox/participant_of.h"
#include "services/link/inbox/sample_check.h"
#include "services/link/inbox/tick_gate.h"
#include "services/link/inbox/world_binding.h"
#include "services/types/refusal.h"

namespace giveway::link {

struct ScanCounters {
  std::uint32_t skipped = 0;          // overwritten by a newer one in the same drain
  std::uint32_t unbound = 0;          // writer not known: dropped
  std::uint32_t wrong_name = 0;       // not for this vehicle: dropped
  std::uint32_t unreadable = 0;       // see FromWire: dropped
  std::uint32_t strangers = 0;        // of a participant that is not the world: dropped
  std::uint32_t implausible = 0;      // out of range, or of a tick that is to come: dropped
  std::uint32_t deadline_missed = 0;  // edges: once until the next scan
};

template <typename Wire, typename Ours>
class ScanInbox {
 public:
  // `world` outlives this. `sample` is how the log calls a scan. `least_period`: from one tick of a
  // world to the next.
  ScanInbox(Reader<Wire> reader, VehicleId own, WorldBinding& world, const char* sample,
            Nanoseconds least_period)
      : reader_(reader), own_(own), world_(world), sample_(sample), gate_(least_period) {}

  // The newest scan since the last call, null if none came. Holds until the next call. `names` must
  // be updated first. `now` is of the clock that worlds are watched by.
  const Ours* Take(const WriterNames& names, SteadyTime now) {
    bool came = false;
    reader_.TakeEach([&](const Wire& sample, const dds::SampleInfo& info) {
      const rtps::GUID_t& writer = info.sample_identity.writer_guid();
      if (!Receive(names.Find(writer), ParticipantOf(writer), sample, now)) return;
      counters_.skipped += came ? 1 : 0;
      latency_ = LatencyOf(info);
      came = true;
    });
    if (came) world_.Heard(now);
    CountMisses(came);
    return came ? &newest_ : nullptr;
  }
  // The first few since the last call.
  void TakeRefusals(std::vector<Refusal>* refusals) {
    for (Refusal& refusal : refusals_) refusals->push_back(std::move(refusal));
    refusals_.clear();
  }
  // Of the newest scan.
  std::optional<Nanoseconds> Latency() const { return latency_; }
  const ScanCounters& Counters() const { return counters_; }
  dds::DataReader& Entity() const { return reader_.Entity(); }

 private:
  bool Receive(const WriterEntry* writer, std::uint64_t participant, const Wire& sample,
               SteadyTime now) {
    Ours scan;
    if (writer == nullptr) {
      ++counters_.unbound;
    } else if (world_.Participant() != 0 && !world_.IsWorld(participant)) {
      ++counters_.strangers;
    } else if (writer->vehicle != own_ || VehicleId{sample.vehicle()} != own_) {
      ++counters_.wrong_name;
    } else if (!FromWire(sample, scan)) {
      ++counters_.unreadable;
    } else if (const auto fault = FaultOfNow(scan, now)) {
      ++counters_.implausible;
      Refuse(writer->identity, *fault);
    } else {
      newest_ = scan;
      return true;
    }
    return false;
  }

  std::optional<FieldFault> FaultOfNow(const Ours& scan, SteadyTime now) {
    if (auto fault = FaultOf(scan)) return fault;
    const auto latest = gate_.Latest(scan.epoch, now);
    if (gate_.Passes(scan.epoch, scan.tick, now)) return std::nullopt;
    return FieldFault{"tick", double(Number(scan.tick)), 1, double(Number(*latest))};
  }

  void Refuse(std::uint64_t writer, const FieldFault& fault) {
    if (refusals_.size() == kMostRefusals) return;
    refusals_.push_back({.sample = sample_,
                         .vehicle = own_,
                         .writer = writer,
                         .counter = "implausible",
                         .field = fault.field,
                         .why = Describe(fault)});
  }

  // An edge, and only while a world is there: the library repeats misses of a gone one for ever.
  void CountMisses(bool scan_came) {
    dds::RequestedDeadlineMissedStatus missed;
    dds::SubscriptionMatchedStatus matched;
    if (!Ok(reader_.Entity().get_requested_deadline_missed_status(missed)) ||
        !Ok(reader_.Entity().get_subscription_matched_status(matched))) {
      return;
    }
    if (missed.total_count_change > 0 && matched.current_count > 0 && !missing_) {
      ++counters_.deadline_missed;
      missing_ = true;
    }
    if (scan_came) missing_ = false;
  }

  static constexpr std::size_t kMostRefusals = 4;

  Reader<Wire> reader_;
  VehicleId own_;
  WorldBinding& world_;
  const char* sample_;
  TickGate gate_;
  std::vector<Refusal> refusals_;
  Ours newest_;
  std::optional<Nanoseconds> latency_;
  ScanCounters counters_;
  bool missing_ = false;
};

}  // namespace giveway::link

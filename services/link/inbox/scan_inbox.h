// The scans of one sensor of one vehicle, of which only the newest is wanted. One writer, so
// statuses are polled.
#pragma once

#include <cstdint>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/endpoint.h"
#include "services/link/fastdds/writer_names.h"

namespace giveway::link {

struct ScanCounters {
  std::uint32_t skipped = 0;          // overwritten by a newer one in the same drain
  std::uint32_t unbound = 0;          // writer not known: dropped
  std::uint32_t wrong_name = 0;       // not for this vehicle: dropped
  std::uint32_t unreadable = 0;       // see FromWire: dropped
  std::uint32_t deadline_missed = 0;  // edges: once until the next scan
};

template <typename Wire, typename Ours>
class ScanInbox {
 public:
  ScanInbox(Reader<Wire> reader, VehicleId own) : reader_(reader), own_(own) {}

  // The newest scan since the last call, null if none came. Holds until the next call. `names` must
  // be updated first.
  const Ours* Take(const WriterNames& names) {
    bool came = false;
    reader_.TakeEach([&](const Wire& sample, const dds::SampleInfo& info) {
      if (!Receive(names.Find(info.sample_identity.writer_guid()), sample)) return;
      counters_.skipped += came ? 1 : 0;
      came = true;
    });
    CountMisses(came);
    return came ? &newest_ : nullptr;
  }
  const ScanCounters& Counters() const { return counters_; }
  dds::DataReader& Entity() const { return reader_.Entity(); }

 private:
  bool Receive(const WriterEntry* writer, const Wire& sample) {
    Ours scan;
    if (writer == nullptr) {
      ++counters_.unbound;
    } else if (writer->vehicle != own_ || VehicleId{sample.vehicle()} != own_) {
      ++counters_.wrong_name;
    } else if (!FromWire(sample, scan)) {
      ++counters_.unreadable;
    } else {
      newest_ = scan;
      return true;
    }
    return false;
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

  Reader<Wire> reader_;
  VehicleId own_;
  Ours newest_;
  ScanCounters counters_;
  bool missing_ = false;
};

}  // namespace giveway::link

#include "services/link/inbox/beacon_inbox.h"

#include <algorithm>
#include <string>

#include "services/link/inbox/latency.h"

namespace giveway::link {
namespace {

constexpr std::size_t kMostRefusedBeacons = 8;  // a drain; the counters have all

}  // namespace

BeaconInbox::BeaconInbox(Reader<wire::Beacon> reader, WriterNames& names,
                         const rtps::GuidPrefix_t& own, ArrivalLog* arrivals)
    : reader_(reader), names_(names), own_(own), arrivals_(arrivals) {}

void BeaconInbox::Drain(SteadyTime now, std::vector<ReceivedBeacon>& beacons,
                        std::vector<QosEvent>* lost) {
  refused_.clear();
  longest_latency_.reset();
  reader_.TakeEach([&](const wire::Beacon& sample, const dds::SampleInfo& info) {
    Receive(sample, info, now, beacons, lost);
  });
  reader_.ForgetDeparted();
}

void BeaconInbox::Receive(const wire::Beacon& sample, const dds::SampleInfo& info, SteadyTime now,
                          std::vector<ReceivedBeacon>& beacons, std::vector<QosEvent>* lost) {
  const rtps::GUID_t& writer = info.sample_identity.writer_guid();
  if (writer.guidPrefix == own_) return;
  WriterEntry* const entry = names_.Find(writer);
  if (entry == nullptr) {
    ++unbound_;
    return;
  }
  const std::uint64_t sequence = info.sample_identity.sequence_number().to64long();
  if (entry->last_sequence != 0 && sequence > entry->last_sequence + 1) {
    gaps_ += sequence - entry->last_sequence - 1;
    if (lost != nullptr) lost->push_back({QosEventKind::kSampleLost, entry->vehicle, now});
  }
  entry->last_sequence = sequence;
  ++entry->taken;
  longest_latency_ = std::max(longest_latency_, LatencyOf(info));  // none is less than any

  ReceivedBeacon& received = beacons.emplace_back();
  const Arrival arrival = FromWire(sample, received.beacon);
  received.received = now;
  received.crc_valid = arrival.crc_valid;
  received.name_valid = entry->vehicle != kNoVehicle && entry->vehicle == received.beacon.vehicle;
  received.writer = entry->identity;
  received.arrival = ArrivalOf(*entry, sequence);
  const bool sound = arrival.crc_valid && arrival.readable && received.name_valid;
  if (!sound) NoteRefusal(sample, *entry, received, arrival);
  // A corrupted beacon counts as corrupted whatever it says; a sound one with values that this
  // build does not know cannot be converted at all.
  if (arrival.crc_valid && !arrival.readable) {
    ++unreadable_;
    ++entry->unreadable;
    beacons.pop_back();
  }
}

BeaconArrival BeaconInbox::ArrivalOf(const WriterEntry& entry, std::uint64_t sequence) {
  BeaconArrival arrival;
  if (arrivals_ != nullptr) arrival = arrivals_->At(entry.identity, sequence).value_or(arrival);
  arrival.taken = entry.taken;
  arrival.unreadable = entry.unreadable;
  return arrival;
}

void BeaconInbox::NoteRefusal(const wire::Beacon& sample, const WriterEntry& entry,
                              const ReceivedBeacon& received, const Arrival& arrival) {
  if (refused_.size() == kMostRefusedBeacons) return;
  Refusal& refusal = refused_.emplace_back();
  refusal.sample = "beacon";
  refusal.vehicle = received.beacon.vehicle;
  refusal.writer = received.writer;
  if (!received.name_valid) {
    refusal.counter = "rejected_wrong_name";
    refusal.field = "vehicle";
    refusal.why =
        "vehicle is " + std::to_string(sample.vehicle()) +
        (entry.vehicle == kNoVehicle ? ", and its writer's partition names none: must be AREA/vID"
                                     : ", must be " + std::to_string(Number(entry.vehicle)) +
                                           " as its writer's partition says");
  } else if (!arrival.crc_valid) {
    refusal.counter = "rejected_crc";
    refusal.field = "crc";
    refusal.why = "crc is " + std::to_string(sample.crc()) + ", must be " +
                  std::to_string(arrival.crc) + " for its fields as they arrived";
  } else {
    const FieldFault fault = FaultOf(sample);
    refusal.counter = "unreadable_samples";
    refusal.field = fault.field;
    refusal.why = Describe(fault);
  }
}

std::uint32_t BeaconInbox::Superseded() {
  dds::SampleLostStatus lost;
  if (!Ok(reader_.Entity().get_sample_lost_status(lost))) return superseded_;
  // A loss is reported before the gap it leaves is seen, hence never downwards.
  const auto lost_count = static_cast<std::uint64_t>(lost.total_count);
  if (gaps_ > lost_count) {
    superseded_ = std::max(superseded_, static_cast<std::uint32_t>(gaps_ - lost_count));
  }
  return superseded_;
}

}  // namespace giveway::link

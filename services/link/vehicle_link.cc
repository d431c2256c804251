#include "services/link/vehicle_link.h"

#include "services/link/beacon_inbox.h"
#include "services/link/convert.h"
#include "services/link/participant.h"
#include "services/link/peer_events.h"
#include "services/link/reader_events.h"
#include "services/link/writer_names.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

constexpr std::size_t kExpectedBeacons = 256;  // a drain; more only costs an allocation, once

// The world's scans of this vehicle. One writer, so its statuses are polled.
class RangesInbox {
 public:
  RangesInbox(Reader<wire::RangeScan> reader, VehicleId own) : reader_(reader), own_(own) {}

  // The newest scan, if any; counts what it skips and refuses.
  std::optional<RangeScan> Take(WriterNames& names, std::uint32_t& skipped,
                                VehicleLinkCounters& counters) {
    std::optional<RangeScan> newest;
    reader_.TakeEach([&](const wire::RangeScan& sample, const dds::SampleInfo& info) {
      const WriterEntry* const entry = names.Find(info.sample_identity.writer_guid());
      RangeScan scan;
      if (entry == nullptr) {
        ++counters.unbound_samples;
      } else if (entry->vehicle != own_ || VehicleId{sample.vehicle()} != own_) {
        ++counters.wrong_name_scans;
      } else if (!FromWire(sample, scan)) {
        ++counters.unreadable_samples;
      } else {
        skipped += newest.has_value() ? 1 : 0;
        newest = scan;
      }
    });
    CountMisses(newest.has_value(), counters);
    return newest;
  }

 private:
  // An edge, and only while a world is there: the library repeats misses of a gone one for ever.
  void CountMisses(bool scan_came, VehicleLinkCounters& counters) {
    dds::RequestedDeadlineMissedStatus missed;
    dds::SubscriptionMatchedStatus matched;
    if (!Ok(reader_.Entity().get_requested_deadline_missed_status(missed)) ||
        !Ok(reader_.Entity().get_subscription_matched_status(matched))) {
      return;
    }
    if (missed.total_count_change > 0 && matched.current_count > 0 && !missing_) {
      ++counters.ranges_deadline_missed;
      missing_ = true;
    }
    if (scan_came) missing_ = false;
  }

  Reader<wire::RangeScan> reader_;
  VehicleId own_;
  bool missing_ = false;
};

// Everything that is named after the vehicle.
struct OwnEndpoints {
  OwnEndpoints(const LinkOptions& options, VehicleId id, Participant& participant,
               WriterNames& names, ReaderEvents& events)
      : beacon_writer(
            participant.MakeWriter<wire::Beacon>(options.area + '/' + VehiclePartition(id))),
        beacon_reader(participant.MakeReader<wire::Beacon>(
            options.area + "/*", Participant::kProfileDepth, &events, ReaderEvents::Mask())),
        ranges_reader(participant.MakeReader<wire::RangeScan>(VehiclePartition(id))),
        command_writer(participant.MakeWriter<wire::MotorCommand>(VehiclePartition(id))),
        status_writer(participant.MakeWriter<wire::Status>(VehiclePartition(id))),
        beacons(beacon_reader, names, participant.Prefix()),
        ranges(ranges_reader, id),
        scan_wait(ranges_reader.Entity()) {}

  Writer<wire::Beacon> beacon_writer;
  Reader<wire::Beacon> beacon_reader;
  Reader<wire::RangeScan> ranges_reader;
  Writer<wire::MotorCommand> command_writer;
  Writer<wire::Status> status_writer;
  BeaconInbox beacons;
  RangesInbox ranges;
  DataWait scan_wait;
};

}  // namespace

struct VehicleLink::Impl {
  explicit Impl(const LinkOptions& link_options)
      : options(link_options),
        participant(options, "giveway-vehicle", names),
        join_writer(participant.MakeWriter<wire::Join>("fleet")),
        roster_reader(participant.MakeReader<wire::Roster>("world")),
        peers(names, participant.Prefix()) {
    taken_beacons.reserve(kExpectedBeacons);
    qos_events.reserve(kExpectedBeacons);
  }

  OwnEndpoints& Own() {
    GIVEWAY_CHECK(own.has_value(), "VehicleLink used before Open");
    return *own;
  }
  void CountWrite(bool written) { counters.write_failures += written ? 0 : 1; }

  LinkOptions options;
  WriterNames names;    // the library calls these two until the participant is gone, so they are
  ReaderEvents events;  // declared before it
  Participant participant;
  Writer<wire::Join> join_writer;
  Reader<wire::Roster> roster_reader;
  PeerEvents peers;
  std::optional<OwnEndpoints> own;
  std::vector<ReceivedBeacon> taken_beacons;
  std::vector<QosEvent> qos_events;
  VehicleLinkCounters counters;
};

VehicleLink::VehicleLink(const LinkOptions& options) : impl_(std::make_unique<Impl>(options)) {}
VehicleLink::~VehicleLink() = default;

void VehicleLink::SendJoin(const JoinRequest& request) {
  impl_->CountWrite(impl_->join_writer.Write(ToWire(request)));
}

std::optional<RosterEntry> VehicleLink::TakeRoster(const SessionId& session) {
  std::optional<RosterEntry> newest;
  impl_->roster_reader.TakeEach([&](const wire::Roster& sample, const dds::SampleInfo&) {
    RosterEntry entry;
    if (!FromWire(sample, entry)) {
      ++impl_->counters.unreadable_samples;
    } else if (entry.session == session) {
      newest = entry;
    }
  });
  return newest;
}

void VehicleLink::Open(VehicleId id) {
  GIVEWAY_CHECK(!impl_->own.has_value(), "VehicleLink opened twice");
  GIVEWAY_CHECK(id != kNobody);
  impl_->own.emplace(impl_->options, id, impl_->participant, impl_->names, impl_->events);
}

bool VehicleLink::WaitForScan(Nanoseconds timeout) { return impl_->Own().scan_wait.Wait(timeout); }

Taken VehicleLink::Take(SteadyTime now) {
  Impl& link = *impl_;
  OwnEndpoints& own = link.Own();
  link.taken_beacons.clear();
  link.qos_events.clear();
  // Events before names: whoever an event is about is then known by name. Events before beacons: a
  // miss is told before the beacon that ends it.
  const auto events = link.events.Take();
  link.names.Update();
  link.peers.Translate(events, now, link.qos_events);

  Taken taken;
  taken.inputs.now = now;
  taken.inputs.scan = own.ranges.Take(link.names, taken.scans_skipped, link.counters);
  own.beacons.Drain(now, link.taken_beacons);
  for (const ReceivedBeacon& received : link.taken_beacons) {
    if (received.crc_valid && received.name_valid) link.peers.Heard(received.beacon.vehicle);
  }
  taken.inputs.beacons = link.taken_beacons;
  taken.inputs.events = link.qos_events;
  return taken;
}

void VehicleLink::Send(const Outputs& outputs) {
  OwnEndpoints& own = impl_->Own();
  // The command first: its reader waits for it.
  impl_->CountWrite(own.command_writer.Write(ToWire(outputs.command)));
  impl_->CountWrite(own.beacon_writer.Write(ToWire(outputs.beacon)));
}

void VehicleLink::SendStatus(const VehicleStatus& status) {
  impl_->CountWrite(impl_->Own().status_writer.Write(ToWire(status)));
}

void VehicleLink::FlushStatus(Nanoseconds timeout) {
  impl_->Own().status_writer.WaitUntilHeard(timeout);
}

VehicleLinkCounters VehicleLink::Counters() const {
  VehicleLinkCounters counters = impl_->counters;
  counters.events_dropped = impl_->events.Dropped();
  counters.matched_peers = impl_->peers.MatchedWriters();
  if (impl_->own.has_value()) {
    BeaconInbox& beacons = impl_->own->beacons;
    counters.beacons_superseded = beacons.Superseded();
    counters.unbound_samples += beacons.Unbound();
    counters.unreadable_samples += beacons.Unreadable();
  }
  return counters;
}

EffectiveBeaconQos VehicleLink::BeaconQos() const {
  const OwnEndpoints& own = impl_->Own();
  const dds::DataWriterQos& offered = own.beacon_writer.Entity().get_qos();
  const dds::DataReaderQos& requested = own.beacon_reader.Entity().get_qos();
  return {.deadline_offered_ms = ToMilliseconds(offered.deadline().period),
          .deadline_requested_ms = ToMilliseconds(requested.deadline().period),
          .lease_ms = ToMilliseconds(requested.liveliness().lease_duration)};
}

}  // namespace giveway::link

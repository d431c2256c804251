#include "services/link/vehicle_link.h"

#include <chrono>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/interface_watch.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/impairment/impairer.h"
#include "services/link/inbox/beacon_inbox.h"
#include "services/link/inbox/peer_events.h"
#include "services/link/inbox/roster_inbox.h"
#include "services/link/inbox/scan_inbox.h"
#include "services/link/inbox/signal_inbox.h"
#include "services/link/participant.h"
#include "services/link/resolved_values.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

constexpr std::size_t kExpectedBeacons = 256;  // a drain; more only costs an allocation, once

// Closing waits for the good-bye to have been heard, until this long after it was said.
constexpr Nanoseconds kLeaveTimeout = std::chrono::milliseconds(300);

template <typename Wire, typename Ours>
using OptionalInbox = std::optional<ScanInbox<Wire, Ours>>;

template <typename Wire, typename Ours>
OptionalInbox<Wire, Ours> MakeInboxIf(bool fitted, Participant& participant, VehicleId id) {
  if (!fitted) return std::nullopt;
  return ScanInbox<Wire, Ours>(participant.MakeReader<Wire>(VehiclePartition(id)), id);
}

// Null if the sensor is not fitted, or says nothing new.
template <typename Wire, typename Ours>
const Ours* NewestOf(OptionalInbox<Wire, Ours>& inbox, const WriterNames& names) {
  return inbox.has_value() ? inbox->Take(names) : nullptr;
}

// The sensors beside the ultrasonics.
struct FittedSensors {
  FittedSensors(VehicleId id, const VehicleProfile& profile, Participant& participant)
      : radar(MakeInboxIf<wire::RadarScan, RadarScan>(profile.radar, participant, id)),
        lidar(MakeInboxIf<wire::LidarScan, LidarScan>(profile.lidar, participant, id)),
        camera(MakeInboxIf<wire::CameraScan, CameraScan>(profile.camera, participant, id)),
        pose_fix(MakeInboxIf<wire::PoseFix, PoseFix>(profile.pose_fix.Fitted(), participant, id)) {}

  void Take(const WriterNames& names, Inputs& inputs) {
    inputs.radar = NewestOf(radar, names);
    inputs.lidar = NewestOf(lidar, names);
    inputs.camera = NewestOf(camera, names);
    if (const PoseFix* fix = NewestOf(pose_fix, names)) inputs.pose_fix = *fix;
  }
  // Calls visit(counters) of each.
  template <typename Visit>
  void ForEachCounters(Visit&& visit) const {
    if (radar) visit(radar->Counters());
    if (lidar) visit(lidar->Counters());
    if (camera) visit(camera->Counters());
    if (pose_fix) visit(pose_fix->Counters());
  }

  OptionalInbox<wire::RadarScan, RadarScan> radar;
  OptionalInbox<wire::LidarScan, LidarScan> lidar;
  OptionalInbox<wire::CameraScan, CameraScan> camera;
  OptionalInbox<wire::PoseFix, PoseFix> pose_fix;
};

// Everything that is named after the vehicle.
struct OwnEndpoints {
  OwnEndpoints(const LinkOptions& options, VehicleId id, const VehicleProfile& profile,
               Participant& participant, WriterNames& names, ReaderEvents& events)
      : beacon_writer(
            participant.MakeWriter<wire::Beacon>(options.area + '/' + VehiclePartition(id))),
        beacon_reader(participant.MakeReader<wire::Beacon>(
            options.area + "/*", Participant::kProfileDepth, &events, ReaderEvents::Mask())),
        command_writer(participant.MakeWriter<wire::MotorCommand>(VehiclePartition(id))),
        status_writer(participant.MakeWriter<wire::Status>(VehiclePartition(id))),
        order_reader(participant.MakeReader<wire::Order>(VehiclePartition(id))),
        answer_writer(participant.MakeWriter<wire::Answer>(VehiclePartition(id))),
        beacons(beacon_reader, names, participant.Prefix()),
        ranges(participant.MakeReader<wire::RangeScan>(VehiclePartition(id)), id),
        sensors(id, profile, participant),
        scan_wait(ranges.Entity()) {
    if (options.partition_free) open_beacon_writer = participant.MakeWriter<wire::Beacon>("");
  }

  // Requested now: an operator may change it while the vehicle drives.
  Nanoseconds BeaconDeadline() const {
    return Nanoseconds(NanosecondsOf(beacon_reader.Entity().get_qos().deadline().period));
  }
  void AddTo(VehicleLinkCounters& counters) {
    counters.beacons_superseded = beacons.Superseded();
    counters.unbound_samples += beacons.Unbound();
    counters.unreadable_samples += beacons.Unreadable();
    counters.ranges_skipped = ranges.Counters().skipped;
    counters.ranges_deadline_missed = ranges.Counters().deadline_missed;
    const auto add = [&counters](const ScanCounters& scans) {
      counters.unbound_samples += scans.unbound;
      counters.unreadable_samples += scans.unreadable;
      counters.wrong_name_scans += scans.wrong_name;
    };
    add(ranges.Counters());
    sensors.ForEachCounters([&](const ScanCounters& scans) {
      add(scans);
      counters.sensors_deadline_missed += scans.deadline_missed;
    });
  }

  Writer<wire::Beacon> beacon_writer;
  std::optional<Writer<wire::Beacon>> open_beacon_writer;  // for tools that set no partition
  Reader<wire::Beacon> beacon_reader;
  Writer<wire::MotorCommand> command_writer;
  Writer<wire::Status> status_writer;
  Reader<wire::Order> order_reader;
  Writer<wire::Answer> answer_writer;
  BeaconInbox beacons;
  ScanInbox<wire::RangeScan, RangeScan> ranges;
  FittedSensors sensors;
  DataWait scan_wait;
};

}  // namespace

struct VehicleLink::Impl {
  explicit Impl(const LinkOptions& link_options)
      : options(link_options),
        participant(options, "giveway-vehicle", names),
        join_writer(participant.MakeWriter<wire::Join>("fleet")),
        roster(participant.MakeReader<wire::Roster>(kWorldPartition)),
        peers(names, participant.Prefix(), options.area) {
    taken_beacons.reserve(kExpectedBeacons);
    qos_events.reserve(kExpectedBeacons);
  }

  ~Impl() {
    if (heard_by) join_writer.WaitUntilHeard(*heard_by);
  }

  void SendJoin(const JoinRequest& request) {
    joined = request;
    roster.Follow(request.session);
    CountWrite(join_writer.Write(ToWire(request)));
  }
  void OpenSignals();
  // What the world says of the run's state; the impairment's blackouts are counted from its start.
  std::optional<RosterEntry> NewestEntry(RosterInbox::Mark& told);
  OwnEndpoints& Own() {
    GIVEWAY_CHECK(own.has_value(), "VehicleLink used before Open");
    return *own;
  }
  void CountWrite(bool written) { counters.write_failures += written ? 0 : 1; }

  LinkOptions options;
  InterfaceWatch interfaces{options.interface};  // before the participant binds to them
  WriterNames names;  // the library calls these three until the participant is gone, so they are
  ReaderEvents events{&RemoveDeparted<wire::Beacon>};  // declared before it
  std::optional<ReaderEvents> signal_events;
  Participant participant;
  Writer<wire::Join> join_writer;
  RosterInbox roster;
  RosterInbox::Mark told_to_join = 0;
  RosterInbox::Mark told_to_step = 0;
  std::optional<JoinRequest> joined;                              // the last request
  std::optional<std::chrono::steady_clock::time_point> heard_by;  // of the good-bye, once said
  PeerEvents peers;
  std::optional<OwnEndpoints> own;
  std::optional<SignalInbox> signals;
  std::vector<ReceivedBeacon> taken_beacons;
  std::vector<QosEvent> qos_events;
  VehicleLinkCounters counters;
};

VehicleLink::VehicleLink(const LinkOptions& options) : impl_(std::make_unique<Impl>(options)) {}
VehicleLink::~VehicleLink() = default;

// An endpoint that every world discovers: not made where no signal is.
void VehicleLink::Impl::OpenSignals() {
  auto reader = participant.MakeReader<wire::SignalState>(
      kWorldPartition, Participant::kProfileDepth, &signal_events.emplace(),
      dds::StatusMask::requested_deadline_missed());
  signals.emplace(reader, *signal_events);
}

std::optional<RosterEntry> VehicleLink::Impl::NewestEntry(RosterInbox::Mark& told) {
  auto entry = roster.NewestAfter(told, names);
  if (entry && entry->run_state == RunState::kRunning && participant.ImpairerOrNull() != nullptr) {
    participant.ImpairerOrNull()->Start(
        SteadyTime(std::chrono::steady_clock::now().time_since_epoch()));
  }
  return entry;
}

std::string VehicleLink::ParticipantText() const { return impl_->participant.PrefixText(); }

std::string VehicleLink::WhyNobodyIsFound() const { return impl_->participant.WhyNobodyIsFound(); }

std::string VehicleLink::InterfaceChange() const { return impl_->interfaces.Change(); }

bool VehicleLink::WorldSpeaks() const {
  if (!impl_->own) return false;
  dds::DataReader& reader = impl_->own->ranges.Entity();
  dds::SubscriptionMatchedStatus matched;
  if (!Ok(reader.get_subscription_matched_status(matched)) || matched.current_count == 0) {
    return false;
  }
  // Without a lease the library keeps no account of who lives.
  const Duration& lease = reader.get_qos().liveliness().lease_duration;
  if (NanosecondsOf(lease) == kInfiniteDuration) return true;
  dds::LivelinessChangedStatus liveliness;
  return Ok(reader.get_liveliness_changed_status(liveliness)) && liveliness.alive_count > 0;
}

void VehicleLink::SendJoin(const JoinRequest& request) { impl_->SendJoin(request); }

void VehicleLink::FlushJoin(Nanoseconds timeout) { impl_->join_writer.WaitUntilHeard(timeout); }

std::optional<RosterEntry> VehicleLink::TakeRoster(const SessionId& session) {
  GIVEWAY_CHECK(impl_->joined && impl_->joined->session == session, "not the session that joined");
  impl_->names.Update();
  return impl_->NewestEntry(impl_->told_to_join);
}

void VehicleLink::SendLeave(const SessionId& session) {
  impl_->SendJoin({.session = session,
                   .wanted = impl_->joined ? impl_->joined->wanted : kNobody,
                   .leaving = true});
  impl_->heard_by = std::chrono::steady_clock::now() + kLeaveTimeout;
}

void VehicleLink::Open(VehicleId id, const VehicleProfile& profile, bool signals) {
  Impl& link = *impl_;
  GIVEWAY_CHECK(!link.own.has_value(), "VehicleLink opened twice");
  GIVEWAY_CHECK(id != kNobody);
  link.own.emplace(link.options, id, profile, link.participant, link.names, link.events);
  if (signals) link.OpenSignals();
  if (Impairer* const impairer = link.participant.ImpairerOrNull()) impairer->NameHearer(id);
  link.told_to_step = link.told_to_join;
  // A world that starts anew must not give another id to a vehicle that already drives as this one.
  if (link.joined && link.joined->wanted != id) link.SendJoin({link.joined->session, id});
}

std::vector<std::string> VehicleLink::TakeUnfit(SteadyTime now) {
  return impl_->participant.TakeUnfit(now);
}

bool VehicleLink::WaitForScan(Nanoseconds timeout) { return impl_->Own().scan_wait.Wait(timeout); }

Taken VehicleLink::Take(SteadyTime now) {
  Impl& link = *impl_;
  OwnEndpoints& own = link.Own();
  link.taken_beacons.clear();
  link.qos_events.clear();
  // Events before names: whoever an event is about is then known by name. Events before beacons: a
  // miss is told before the beacon that ends it.
  const ReaderNews news = link.events.Take();
  link.names.Update();
  link.peers.Translate(news, now, link.qos_events);

  Taken taken;
  taken.inputs.now = now;
  const std::uint32_t skipped = own.ranges.Counters().skipped;
  if (const RangeScan* scan = own.ranges.Take(link.names)) taken.inputs.scan = *scan;
  taken.scans_skipped = own.ranges.Counters().skipped - skipped;
  own.sensors.Take(link.names, taken.inputs);
  if (link.signals) taken.inputs.signals = link.signals->Take();
  taken.inputs.roster = link.NewestEntry(link.told_to_step);
  own.beacons.Drain(now, link.taken_beacons, &link.qos_events);
  for (const ReceivedBeacon& received : link.taken_beacons) {
    if (received.crc_valid && received.name_valid) link.peers.Heard(received.beacon.vehicle, now);
  }
  link.peers.Watch(now, own.BeaconDeadline(), link.qos_events);
  taken.inputs.beacons = link.taken_beacons;
  taken.inputs.events = link.qos_events;
  taken.refusals = own.beacons.Refused();
  return taken;
}

void VehicleLink::Send(const Outputs& outputs) {
  OwnEndpoints& own = impl_->Own();
  // The command first: its reader waits for it.
  impl_->CountWrite(own.command_writer.Write(ToWire(outputs.command)));
  const wire::Beacon beacon = ToWire(outputs.beacon);
  impl_->CountWrite(own.beacon_writer.Write(beacon));
  if (own.open_beacon_writer) impl_->CountWrite(own.open_beacon_writer->Write(beacon));
}

void VehicleLink::SendStatus(const VehicleStatus& status) {
  impl_->CountWrite(impl_->Own().status_writer.Write(ToWire(status)));
}

void VehicleLink::FlushStatus(Nanoseconds timeout) {
  impl_->Own().status_writer.WaitUntilHeard(timeout);
}

std::vector<AdminOrder> VehicleLink::TakeOrders() {
  std::vector<AdminOrder> orders;
  impl_->Own().order_reader.TakeEach([&](const wire::Order& sample, const dds::SampleInfo&) {
    AdminOrder order;
    if (FromWire(sample, order)) orders.push_back(std::move(order));
  });
  return orders;
}

void VehicleLink::SendAnswer(const AdminAnswer& answer) {
  impl_->CountWrite(impl_->Own().answer_writer.Write(ToWire(answer)));
}

void VehicleLink::FlushAnswer(Nanoseconds timeout) {
  impl_->Own().answer_writer.WaitUntilHeard(timeout);
}

std::vector<LiveValue> VehicleLink::LiveQos() const { return impl_->participant.LiveQos(); }

bool VehicleLink::SetDeadline(const std::string& profile, std::int64_t deadline) {
  return impl_->participant.SetDeadline(profile, ToDuration(deadline));
}

VehicleLinkCounters VehicleLink::Counters() const {
  VehicleLinkCounters counters = impl_->counters;
  counters.events_dropped = impl_->events.Dropped();
  counters.deadline_watches_lost = DeadlineWatchesLost();
  counters.matched_peers = impl_->peers.MatchedWriters();
  counters.unreadable_samples = impl_->roster.Unreadable();
  counters.old_world_entries = impl_->roster.FromOldWorlds();
  if (impl_->signals) {
    counters.unreadable_samples += impl_->signals->Unreadable();
    counters.signals_deadline_missed = impl_->signals->DeadlineMissed();
  }
  if (impl_->own) impl_->own->AddTo(counters);
  counters.impaired = Impaired().value_or(ImpairmentCounters{});
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

std::optional<ImpairmentCounters> VehicleLink::Impaired() const {
  const Impairer* const impairer = impl_->participant.ImpairerOrNull();
  if (impairer == nullptr) return std::nullopt;
  return impairer->Counters();
}

std::optional<SteadyTime> VehicleLink::BlackoutsSince() const {
  const Impairer* const impairer = impl_->participant.ImpairerOrNull();
  if (impairer == nullptr) return std::nullopt;
  return impairer->Started();
}

}  // namespace giveway::link

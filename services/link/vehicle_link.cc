#include "services/link/vehicle_link.h"

#include <array>
#include <chrono>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/interface_watch.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/impairment/impairer.h"
#include "services/link/inbox/arrival_log.h"
#include "services/link/inbox/beacon_inbox.h"
#include "services/link/inbox/peer_events.h"
#include "services/link/inbox/roster_inbox.h"
#include "services/link/inbox/scan_inbox.h"
#include "services/link/inbox/signal_inbox.h"
#include "services/link/link_clock.h"
#include "services/link/participant.h"
#include "services/link/resolved_values.h"
#include "services/link/sample_filter.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

constexpr std::size_t kExpectedBeacons = 256;  // a drain; more only costs an allocation, once

// Closing waits until the leave notice is acknowledged, at most this long after it was sent.
constexpr Nanoseconds kLeaveTimeout = std::chrono::milliseconds(300);

template <typename Wire, typename Ours>
using OptionalInbox = std::optional<ScanInbox<Wire, Ours>>;

// What the readers of a world's topics need: which writers count, and how fast ticks can come.
struct WorldReaders {
  WorldBinding& binding;
  Nanoseconds tick_period;
};

template <typename Wire, typename Ours>
OptionalInbox<Wire, Ours> MakeInboxIf(bool fitted, Participant& participant, VehicleId id,
                                      const WorldReaders& world, SampleFilter* filter) {
  if (!fitted) return std::nullopt;
  return ScanInbox<Wire, Ours>(participant.MakeReader<Wire>(VehiclePartition(id), filter), id,
                               world.binding, "scan", world.tick_period);
}

// Null if the sensor is not fitted, or says nothing new.
template <typename Wire, typename Ours>
const Ours* NewestOf(OptionalInbox<Wire, Ours>& inbox, const WriterNames& names, SteadyTime now) {
  return inbox.has_value() ? inbox->Take(names, now) : nullptr;
}

// The sensors besides the ultrasonics.
struct FittedSensors {
  FittedSensors(VehicleId id, const RobotModel& profile, Participant& participant,
                const WorldReaders& world, SampleFilter* filter)
      : radar(
            MakeInboxIf<wire::RadarScan, RadarScan>(profile.radar, participant, id, world, filter)),
        lidar(
            MakeInboxIf<wire::LidarScan, LidarScan>(profile.lidar, participant, id, world, filter)),
        camera(MakeInboxIf<wire::CameraScan, CameraScan>(profile.camera, participant, id, world,
                                                         filter)),
        pose_fix(MakeInboxIf<wire::PoseFix, PoseFix>(profile.pose_fix.Fitted(), participant, id,
                                                     world, filter)) {}

  void Take(const WriterNames& names, SteadyTime now, Inputs& inputs) {
    inputs.radar = NewestOf(radar, names, now);
    inputs.lidar = NewestOf(lidar, names, now);
    inputs.camera = NewestOf(camera, names, now);
    if (const PoseFix* fix = NewestOf(pose_fix, names, now)) inputs.pose_fix = *fix;
  }
  // Calls visit(inbox) of each.
  template <typename Visit>
  void ForEach(Visit&& visit) {
    if (radar) visit(*radar);
    if (lidar) visit(*lidar);
    if (camera) visit(*camera);
    if (pose_fix) visit(*pose_fix);
  }

  OptionalInbox<wire::RadarScan, RadarScan> radar;
  OptionalInbox<wire::LidarScan, LidarScan> lidar;
  OptionalInbox<wire::CameraScan, CameraScan> camera;
  OptionalInbox<wire::PoseFix, PoseFix> pose_fix;
};

// What the readers of a vehicle take no notice of. The library asks them until the participant is
// gone.
struct Filters {
  explicit Filters(const WorldBinding& world)
      : scans("scan", world.Participant()), signals("signal", world.Participant()) {
    beacons.LogArrivals(&beacon_arrivals);
  }

  void TakeRefusals(std::vector<Refusal>* refusals) {
    for (SampleFilter* filter : All()) filter->TakeRefusals(refusals);
  }
  std::uint32_t Refused() {
    std::uint32_t refused = 0;
    for (SampleFilter* filter : All()) refused += filter->Refused();
    return refused;
  }
  std::array<SampleFilter*, 5> All() { return {&roster, &beacons, &scans, &signals, &orders}; }

  ArrivalLog beacon_arrivals;
  SessionFilter roster{"roster entry"};
  KeyQuota beacons{"beacon", KeyQuota::Key::kVehicle, KeyQuota::Of::kWriter, kMostIdsOfWriter};
  WorldFilter scans;
  WorldFilter signals;
  KeyQuota orders{"order", KeyQuota::Key::kVehicle, KeyQuota::Of::kWriter, kMostIdsOfWriter};
};

// Everything that is named after the vehicle.
struct OwnEndpoints {
  OwnEndpoints(const LinkOptions& options, const ServiceOptions& service, VehicleId id,
               const RobotModel& profile, Participant& participant, WriterNames& names,
               ReaderEvents& events, WorldBinding& binding, Filters& filters)
      : beacon_writer(
            participant.MakeWriter<wire::Beacon>(options.area + '/' + VehiclePartition(id))),
        beacon_reader(participant.MakeReader<wire::Beacon>(options.area + "/*",
                                                           Participant::kProfileDepth, &events,
                                                           ReaderEvents::Mask(), &filters.beacons)),
        command_writer(participant.MakeWriter<wire::MotorCommand>(VehiclePartition(id))),
        status_writer(participant.MakeWriter<wire::Status>(VehiclePartition(id))),
        beacons(beacon_reader, names, participant.Prefix(), &filters.beacon_arrivals),
        ranges(participant.MakeReader<wire::RangeScan>(VehiclePartition(id), &filters.scans), id,
               binding, "scan", service.tick_period),
        sensors(id, profile, participant, {binding, service.tick_period}, &filters.scans),
        scan_wait(ranges.Entity()) {
    if (service.takes_orders) {
      order_reader.emplace(
          participant.MakeReader<wire::Order>(VehiclePartition(id), &filters.orders));
      answer_writer.emplace(participant.MakeWriter<wire::Answer>(VehiclePartition(id)));
    }
    if (options.partition_free) open_beacon_writer = participant.MakeWriter<wire::Beacon>("");
  }

  // Requested now: an operator may change it while the vehicle drives.
  Nanoseconds BeaconDeadline() const {
    return Nanoseconds(NanosecondsOf(beacon_reader.Entity().get_qos().deadline().period));
  }
  void AddTo(VehicleLinkCounters& counters) {
    counters.beacons_superseded = beacons.Superseded();
    counters.refused.unbound_samples += beacons.Unbound();
    counters.refused.unreadable_samples += beacons.Unreadable();
    counters.ranges_skipped = ranges.Counters().skipped;
    counters.ranges_deadline_missed = ranges.Counters().deadline_missed;
    const auto add = [&counters](const ScanCounters& scans) {
      counters.refused.unbound_samples += scans.unbound;
      counters.refused.unreadable_samples += scans.unreadable;
      counters.refused.wrong_name_scans += scans.wrong_name;
      counters.refused.strangers += scans.strangers;
      counters.refused.implausible += scans.implausible;
    };
    add(ranges.Counters());
    sensors.ForEach([&](const auto& inbox) {
      add(inbox.Counters());
      counters.sensors_deadline_missed += inbox.Counters().deadline_missed;
    });
  }
  void TakeRefusals(std::vector<Refusal>* refusals) {
    refusals->insert(refusals->end(), beacons.Refused().begin(), beacons.Refused().end());
    ranges.TakeRefusals(refusals);
    sensors.ForEach([&](auto& inbox) { inbox.TakeRefusals(refusals); });
  }

  Writer<wire::Beacon> beacon_writer;
  std::optional<Writer<wire::Beacon>> open_beacon_writer;  // for tools that set no partition
  Reader<wire::Beacon> beacon_reader;
  Writer<wire::MotorCommand> command_writer;
  Writer<wire::Status> status_writer;
  std::optional<Reader<wire::Order>> order_reader;
  std::optional<Writer<wire::Answer>> answer_writer;
  BeaconInbox beacons;
  ScanInbox<wire::RangeScan, RangeScan> ranges;
  FittedSensors sensors;
  DataWait scan_wait;
};

}  // namespace

struct VehicleLink::Impl {
  Impl(const LinkOptions& link_options, const ServiceOptions& service_options)
      : options(link_options),
        service(service_options),
        participant(options, "giveway-vehicle", names, Participant::Endpoints::kJudged),
        join_writer(participant.MakeWriter<wire::Join>("fleet")),
        roster(participant.MakeReader<wire::Roster>(kWorldPartition, &filters.roster), world),
        peers(names, participant.Prefix(), options.area) {
    taken_beacons.reserve(kExpectedBeacons);
    qos_events.reserve(kExpectedBeacons);
  }

  ~Impl() {
    if (heard_by) join_writer.WaitUntilHeard(*heard_by);
  }

  // One that asks again may not have the secret at hand, which must still be there to leave with.
  void SendJoin(const JoinRequest& request) {
    const bool again = joined && joined->session == request.session;
    const SessionId secret =
        again && request.secret == SessionId{} ? joined->secret : request.secret;
    joined = request;
    joined->secret = secret;
    roster.Follow(request.session);
    filters.roster.Follow(request.session);
    JoinRequest said = request;
    if (!request.leaving) said.secret = {};  // sent once, when it ends the session
    CountWrite(join_writer.Write(ToWire(said)));
  }
  void OpenSignals();
  // What the world says of the run's state; the impairment's blackouts are counted from its start.
  std::optional<RosterEntry> NewestEntry(RosterInbox::Mark& seen);
  OwnEndpoints& Own() {
    GIVEWAY_CHECK(own.has_value(), "VehicleLink used before Open");
    return *own;
  }
  void CountWrite(bool written) { counters.write_failures += written ? 0 : 1; }

  LinkOptions options;
  ServiceOptions service;
  WorldBinding world{service.tick_period};
  Filters filters{world};  // the library asks them until the participant is gone
  InterfaceWatch interfaces{options.interface};  // before the participant binds to them
  WriterNames names;  // the library calls these three until the participant is gone, so they are
  ReaderEvents events{&RemoveDeparted<wire::Beacon>};  // declared before it
  std::optional<ReaderEvents> signal_events;
  Participant participant;
  Writer<wire::Join> join_writer;
  RosterInbox roster;
  RosterInbox::Mark seen_by_join = 0;
  RosterInbox::Mark seen_by_step = 0;
  std::optional<JoinRequest> joined;                              // the last request
  std::optional<std::chrono::steady_clock::time_point> heard_by;  // of the leave notice, once sent
  PeerEvents peers;
  std::optional<OwnEndpoints> own;
  std::optional<SignalInbox> signals;
  std::vector<ReceivedBeacon> taken_beacons;
  std::vector<QosEvent> qos_events;
  std::vector<Refusal> refusals;
  VehicleLinkCounters counters;
};

VehicleLink::VehicleLink(const LinkOptions& options, const ServiceOptions& service)
    : impl_(std::make_unique<Impl>(options, service)) {}
VehicleLink::~VehicleLink() = default;

// An endpoint that every world discovers: not made where no signal is.
void VehicleLink::Impl::OpenSignals() {
  auto reader = participant.MakeReader<wire::SignalState>(
      kWorldPartition, Participant::kProfileDepth, &signal_events.emplace(),
      dds::StatusMask::requested_deadline_missed(), &filters.signals);
  signals.emplace(reader, *signal_events, world, service.tick_period);
}

std::optional<RosterEntry> VehicleLink::Impl::NewestEntry(RosterInbox::Mark& seen) {
  auto entry = roster.NewestAfter(seen, names, LinkNow());
  if (entry && entry->run_state == RunState::kRunning && participant.ImpairerOrNull() != nullptr) {
    participant.ImpairerOrNull()->Start(LinkNow());
  }
  return entry;
}

std::string VehicleLink::ParticipantText() const { return impl_->participant.PrefixText(); }

std::string VehicleLink::WhyNoPeerIsFound() const { return impl_->participant.WhyNoPeerIsFound(); }

std::string VehicleLink::InterfaceChange() const { return impl_->interfaces.Change(); }
bool VehicleLink::SharedMemoryIsGone() { return impl_->participant.SharedMemoryIsGone(); }

bool VehicleLink::WorldSpeaks() const {
  if (!impl_->own) return false;
  dds::DataReader& reader = impl_->own->ranges.Entity();
  dds::SubscriptionMatchedStatus matched;
  if (!Ok(reader.get_subscription_matched_status(matched)) || matched.current_count == 0) {
    return false;
  }
  // Without a lease the library keeps no account of live writers.
  const Duration& lease = reader.get_qos().liveliness().lease_duration;
  if (NanosecondsOf(lease) == kInfiniteDuration) return true;
  dds::LivelinessChangedStatus liveliness;
  return Ok(reader.get_liveliness_changed_status(liveliness)) && liveliness.alive_count > 0;
}

bool VehicleLink::LacksBody() const {
  if (!impl_->own || !impl_->roster.WorldIsThere(impl_->names)) return false;
  dds::SubscriptionMatchedStatus matched;
  return Ok(impl_->own->ranges.Entity().get_subscription_matched_status(matched)) &&
         matched.current_count == 0;
}

void VehicleLink::SendJoin(const JoinRequest& request) { impl_->SendJoin(request); }

void VehicleLink::FlushJoin(Nanoseconds timeout) { impl_->join_writer.WaitUntilHeard(timeout); }

std::optional<RosterEntry> VehicleLink::TakeRoster(const SessionId& session) {
  GIVEWAY_CHECK(impl_->joined && impl_->joined->session == session, "not the session that joined");
  impl_->names.Update();
  return impl_->NewestEntry(impl_->seen_by_join);
}

void VehicleLink::SendLeave(const SessionId& session) {
  const std::optional<JoinRequest>& joined = impl_->joined;
  const bool knows = joined && joined->session == session;
  const SessionId secret = knows ? joined->secret : SessionId{};
  impl_->SendJoin({.session = session,
                   .wanted = joined ? joined->wanted : kNoVehicle,
                   .leaving = true,
                   .secret = secret});
  impl_->heard_by = std::chrono::steady_clock::now() + kLeaveTimeout;
}

void VehicleLink::Open(VehicleId id, const RobotModel& profile, bool signals) {
  Impl& link = *impl_;
  GIVEWAY_CHECK(!link.own.has_value(), "VehicleLink opened twice");
  GIVEWAY_CHECK(id != kNoVehicle);
  link.own.emplace(link.options, link.service, id, profile, link.participant, link.names,
                   link.events, link.world, link.filters);
  link.roster.NameOwn(id);
  link.world.ExpectScans(LinkNow());
  if (signals) link.OpenSignals();
  if (Impairer* const impairer = link.participant.ImpairerOrNull()) impairer->NameHearer(id);
  link.seen_by_step = link.seen_by_join;
  // A restarted world must not give another id to a vehicle that already drives as this one.
  if (link.joined && link.joined->wanted != id) {
    JoinRequest request = *link.joined;
    request.wanted = id;
    link.SendJoin(request);
  }
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
  // Events before names: the vehicle of an event is then known by name. Events before beacons: a
  // miss is reported before the beacon that ends it.
  const ReaderNews news = link.events.Take();
  link.names.Update();
  link.peers.Translate(news, now, link.qos_events);

  Taken taken;
  taken.inputs.now = now;
  const std::uint32_t skipped = own.ranges.Counters().skipped;
  const SteadyTime real_now = LinkNow();  // worlds are watched by it, whatever `now` is
  if (const RangeScan* scan = own.ranges.Take(link.names, real_now)) taken.inputs.scan = *scan;
  if (taken.inputs.scan) taken.scan_latency = own.ranges.Latency();
  taken.scans_skipped = own.ranges.Counters().skipped - skipped;
  own.sensors.Take(link.names, real_now, taken.inputs);
  if (link.signals) taken.inputs.signals = link.signals->Take(real_now);
  taken.inputs.roster = link.NewestEntry(link.seen_by_step);
  own.beacons.Drain(now, link.taken_beacons, &link.qos_events);
  taken.beacon_latency = own.beacons.LongestLatency();
  for (const ReceivedBeacon& received : link.taken_beacons) {
    if (received.crc_valid && received.name_valid) link.peers.Heard(received.beacon.vehicle, now);
  }
  link.peers.Watch(now, own.BeaconDeadline(), link.qos_events);
  taken.inputs.beacons = link.taken_beacons;
  taken.inputs.events = link.qos_events;
  link.refusals.clear();
  own.TakeRefusals(&link.refusals);
  link.roster.TakeRefusals(&link.refusals);
  link.filters.TakeRefusals(&link.refusals);
  taken.refusals = link.refusals;
  taken.left = link.names.LeftNow();
  link.filters.beacon_arrivals.NoteLeft(taken.left);
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

std::vector<AdminRequest> VehicleLink::TakeAdminRequests() {
  std::vector<AdminRequest> orders;
  auto& reader = impl_->Own().order_reader;
  if (!reader) return orders;
  reader->TakeEach([&](const wire::Order& sample, const dds::SampleInfo&) {
    AdminRequest order;
    if (FromWire(sample, order)) orders.push_back(std::move(order));
  });
  return orders;
}

void VehicleLink::SendAnswer(const AdminAnswer& answer) {
  auto& writer = impl_->Own().answer_writer;
  if (writer) impl_->CountWrite(writer->Write(ToWire(answer)));
}

void VehicleLink::FlushAnswer(Nanoseconds timeout) {
  auto& writer = impl_->Own().answer_writer;
  if (writer) writer->WaitUntilHeard(timeout);
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
  counters.refused.unreadable_samples = impl_->roster.Unreadable();
  counters.refused.old_world_entries = impl_->roster.FromOtherWorlds();
  counters.refused.strangers = impl_->filters.Refused();
  counters.refused.implausible = impl_->roster.Implausible();
  if (impl_->signals) {
    counters.refused.unreadable_samples += impl_->signals->Unreadable();
    counters.refused.strangers += impl_->signals->Strangers();
    counters.refused.implausible += impl_->signals->Implausible();
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

#include "services/link/world_link.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <unordered_map>
#include <utility>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/anchored_reader.h"
#include "services/link/fastdds/interface_watch.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/inbox/join_inbox.h"
#include "services/link/inbox/latency.h"
#include "services/link/inbox/participant_of.h"
#include "services/link/inbox/peer_events.h"
#include "services/link/inbox/sample_check.h"
#include "services/link/link_clock.h"
#include "services/link/participant.h"
#include "services/link/resolved_values.h"
#include "services/link/roster_outbox.h"
#include "services/link/vehicle_writers.h"
#include "services/types/check.h"
#include "services/types/figures/measured_figure.h"

namespace giveway::link {
namespace {

// Of one participant: more than it may ask for, see session_owners.h, for some of them are over.
constexpr std::size_t kMostSessions = 32;
constexpr std::size_t kMostRefusals = 8;  // kept for the log; the counters have all

}  // namespace

struct WorldLink::Impl {
  Impl(const LinkOptions& options, const ServiceOptions& service)
      : interfaces(options.interface),
        participant(options, "giveway-world", names, Participant::Endpoints::kJudged),
        joins(participant.MakeReader<wire::Join>("fleet", &join_quota), service.tick_period),
        command_reader(participant.MakeReader<wire::MotorCommand>(
            "v*", Participant::kProfileDepth, &events,
            dds::StatusMask::subscription_matched() << dds::StatusMask::requested_deadline_missed(),
            &command_owners)),
        roster(participant.MakeWriter<wire::Roster>(kWorldPartition)),
        signal_writer(participant.MakeWriter<wire::SignalState>(kWorldPartition)),
        truth_writer(participant.MakeWriter<wire::Truth>(kWorldPartition)),
        event_writer(
            participant.MakeWriter<wire::Event>(kWorldPartition, EventDepth(options.fleet_size))),
        figures_writer(participant.MakeWriter<wire::Figures>(kWorldPartition)),
        vehicles(names, participant.Prefix(), ""),
        command_wait(command_reader.Entity()) {
    if (!service.takes_orders) return;
    order_reader.emplace(
        participant.MakeReader<wire::Order>(VehiclePartition(kNoVehicle), &order_ids));
    answer_writer.emplace(participant.MakeWriter<wire::Answer>(VehiclePartition(kNoVehicle)));
  }

  void FollowDiscovery() {
    const auto queued = events.Take();  // before the names, see VehicleLink::Take
    names.Update();
    discarded.clear();
    vehicles.Translate(queued, SteadyTime{0}, discarded);
  }
  void Receive(const wire::MotorCommand& sample, const dds::SampleInfo& info);
  // Sets the participant whose commands count for the vehicle from now on.
  void FollowOwner(VehicleId vehicle);
  template <typename Scan>
  void Send(const Scan& scan);
  void NoteRefusal(Refusal refusal) {
    if (refusals.size() < kMostRefusals) refusals.push_back(std::move(refusal));
  }
  void CountWrite(bool written) { counters.write_failures += written ? 0 : 1; }

  InterfaceWatch interfaces;  // before the participant binds to them
  WriterNames names;  // the library calls these two until the participant is gone, so they are
  ReaderEvents events{&RemoveDeparted<wire::MotorCommand>};  // declared before it
  KeyQuota join_quota{"join", KeyQuota::Key::kSession, KeyQuota::Of::kParticipant, kMostSessions};
  OwnerFilter command_owners{"motor command"};
  KeyQuota order_ids{"order", KeyQuota::Key::kVehicle, KeyQuota::Of::kWriter, kMostIdsOfWriter};
  Participant participant;
  JoinInbox joins;
  AnchoredReader<wire::MotorCommand> command_reader;
  RosterOutbox roster;
  Writer<wire::SignalState> signal_writer;
  Writer<wire::Truth> truth_writer;
  Writer<wire::Event> event_writer;
  Writer<wire::Figures> figures_writer;
  std::optional<Reader<wire::Order>> order_reader;
  std::optional<Writer<wire::Answer>> answer_writer;
  std::unordered_map<VehicleId, VehicleWriters> writers;
  PeerEvents vehicles;  // by their command writers
  DataWait command_wait;
  std::vector<MotorCommand> commands;
  std::chrono::system_clock::time_point taken_at;
  MeasuredFigure command_latency_us;
  std::vector<QosEvent> discarded;
  std::vector<Refusal> refusals;
  WorldLinkCounters counters;
  std::uint32_t strangers = 0;  // commands
};

void WorldLink::Impl::Receive(const wire::MotorCommand& sample, const dds::SampleInfo& info) {
  ++counters.commands_taken;
  const WriterEntry* const entry = names.Find(info.sample_identity.writer_guid());
  MotorCommand command;
  if (entry == nullptr) {
    ++counters.commands_unbound;
  } else if (entry->vehicle == kNoVehicle || entry->vehicle != VehicleId{sample.vehicle()}) {
    ++counters.commands_wrong_name;
    const std::string wanted =
        entry->vehicle == kNoVehicle ? "none" : std::to_string(Number(entry->vehicle));
    NoteRefusal({.sample = "motor command",
                 .vehicle = VehicleId{sample.vehicle()},
                 .writer = entry->identity,
                 .counter = "commands_wrong_name",
                 .field = "vehicle",
                 .why = "vehicle is " + std::to_string(sample.vehicle()) +
                        ", and its writer's partition names " + wanted + ": must be v" +
                        std::to_string(sample.vehicle())});
  } else if (const std::uint64_t owner = joins.Owners().OwnerOf(entry->vehicle);
             owner != 0 && owner != ParticipantOf(info.sample_identity.writer_guid())) {
    ++strangers;  // the library lets what is marked as filtered already pass its filter
  } else if (const bool read = FromWire(sample, command); !read || FaultOf(command)) {
    ++counters.commands_not_finite;
    const FieldFault fault = read ? *FaultOf(command) : FaultOf(sample);
    NoteRefusal({.sample = "motor command",
                 .vehicle = entry->vehicle,
                 .writer = entry->identity,
                 .counter = "commands_not_finite",
                 .field = fault.field,
                 .why = Describe(fault)});
  } else {
    commands.push_back(command);
    if (const auto latency = LatencyUntil(taken_at, info))
      command_latency_us.Add(Milliseconds(*latency) * 1e3);
    joins.Owners().Heard(command.vehicle, LinkNow());
  }
}

void WorldLink::Impl::FollowOwner(VehicleId vehicle) {
  command_owners.SetOwner(vehicle, joins.Owners().OwnerOf(vehicle));
}

WorldLink::WorldLink(const LinkOptions& options, const ServiceOptions& service)
    : impl_(std::make_unique<Impl>(options, service)) {}
WorldLink::~WorldLink() = default;

std::string WorldLink::ParticipantText() const { return impl_->participant.PrefixText(); }

std::string WorldLink::WhyNoPeerIsFound() const { return impl_->participant.WhyNoPeerIsFound(); }
std::string WorldLink::InterfaceChange() const { return impl_->interfaces.Change(); }
bool WorldLink::SharedMemoryIsGone() { return impl_->participant.SharedMemoryIsGone(); }

template <typename Scan>
void WorldLink::Impl::Send(const Scan& scan) {
  const auto found = writers.find(scan.vehicle);
  GIVEWAY_CHECK(found != writers.end(), Number(scan.vehicle));
  CountWrite(found->second.Write(ToWire(scan)));
}

void WorldLink::OpenVehicle(VehicleId vehicle, const RobotModel& profile) {
  GIVEWAY_CHECK(vehicle != kNoVehicle);
  impl_->writers.try_emplace(vehicle, impl_->participant, vehicle, profile);
}

void WorldLink::CloseVehicle(VehicleId vehicle) {
  impl_->writers.erase(vehicle);
  impl_->roster.Retire(vehicle);
  impl_->joins.Owners().Close(vehicle);
  impl_->FollowOwner(vehicle);
}

void WorldLink::ForgetVehicle(VehicleId vehicle) {
  wire::Truth truth;
  truth.vehicle(Number(vehicle));
  impl_->truth_writer.Retire(truth);
}

bool WorldLink::IsMatched(VehicleId vehicle) const {
  impl_->FollowDiscovery();
  const auto found = impl_->writers.find(vehicle);
  return found != impl_->writers.end() && found->second.HaveReaders() &&
         impl_->vehicles.IsMatched(vehicle);
}

std::vector<JoinRequest> WorldLink::TakeJoins() {
  Impl& link = *impl_;
  link.FollowDiscovery();
  auto joins = link.joins.Take(link.names, LinkNow(), link.refusals);
  // A session may have come from another participant.
  for (const JoinRequest& request : joins) {
    for (const VehicleId vehicle : link.joins.Owners().VehiclesOf(request.session)) {
      link.FollowOwner(vehicle);
    }
  }
  return joins;
}

std::span<const MotorCommand> WorldLink::TakeCommands() {
  impl_->FollowDiscovery();
  impl_->command_reader.ForgetDeparted();
  impl_->commands.clear();
  impl_->taken_at = std::chrono::system_clock::now();
  impl_->command_reader.TakeEach(
      [&](const wire::MotorCommand& sample, const dds::SampleInfo& info) {
        impl_->Receive(sample, info);
      });
  return impl_->commands;
}

std::vector<Refusal> WorldLink::TakeRefusals() {
  std::vector<Refusal> refusals = std::exchange(impl_->refusals, {});
  impl_->command_owners.TakeRefusals(&refusals);
  impl_->join_quota.TakeRefusals(&refusals);
  impl_->order_ids.TakeRefusals(&refusals);
  return refusals;
}

std::vector<std::string> WorldLink::TakeUnfit(SteadyTime now) {
  return impl_->participant.TakeUnfit(now);
}

bool WorldLink::WaitForCommands(Nanoseconds timeout) { return impl_->command_wait.Wait(timeout); }

void WorldLink::SendRoster(const RosterEntry& entry) {
  if (entry.accepted) {
    impl_->joins.Owners().Accept(entry.vehicle, entry.session);
    impl_->FollowOwner(entry.vehicle);
  }
  impl_->CountWrite(impl_->roster.Send(entry));
}

void WorldLink::SendSignal(const SignalState& state) {
  impl_->CountWrite(impl_->signal_writer.Write(ToWire(state)));
}

void WorldLink::SendRadar(const RadarScan& scan) { impl_->Send(scan); }
void WorldLink::SendLidar(const LidarScan& scan) { impl_->Send(scan); }
void WorldLink::SendCamera(const CameraScan& scan) { impl_->Send(scan); }
void WorldLink::SendPoseFix(const PoseFix& fix) { impl_->Send(fix); }
void WorldLink::SendScan(const RangeScan& scan) { impl_->Send(scan); }

void WorldLink::SendTruth(const Truth& truth) {
  impl_->CountWrite(impl_->truth_writer.Write(ToWire(truth)));
}

void WorldLink::SendEvent(const WorldEvent& event) {
  impl_->CountWrite(impl_->event_writer.Write(ToWire(event)));
}

void WorldLink::SendFigures(const RunFigures& figures) {
  impl_->CountWrite(impl_->figures_writer.Write(ToWire(figures)));
}

std::vector<AdminRequest> WorldLink::TakeAdminRequests() {
  std::vector<AdminRequest> orders;
  if (!impl_->order_reader) return orders;
  impl_->order_reader->TakeEach([&](const wire::Order& sample, const dds::SampleInfo&) {
    AdminRequest order;
    if (FromWire(sample, order)) orders.push_back(std::move(order));
  });
  return orders;
}

void WorldLink::SendAnswer(const AdminAnswer& answer) {
  if (impl_->answer_writer) impl_->CountWrite(impl_->answer_writer->Write(ToWire(answer)));
}

void WorldLink::FlushAnswer(Nanoseconds timeout) {
  if (impl_->answer_writer) impl_->answer_writer->WaitUntilHeard(timeout);
}

std::vector<LiveValue> WorldLink::LiveQos() const { return impl_->participant.LiveQos(); }

bool WorldLink::SetDeadline(const std::string& profile, std::int64_t deadline) {
  return impl_->participant.SetDeadline(profile, ToDuration(deadline));
}

void WorldLink::Flush(Nanoseconds timeout) {
  // If a reader has died silently each of them waits until the timeout, in which the others are
  // heard as well: so one timeout serves all.
  const auto until = std::chrono::steady_clock::now() + timeout;
  impl_->roster.WaitUntilHeard(until);
  impl_->event_writer.WaitUntilHeard(until);
  impl_->figures_writer.WaitUntilHeard(until);
}

WorldLinkCounters WorldLink::Counters() const {
  WorldLinkCounters counters = impl_->counters;
  counters.joins_refused = impl_->joins.Refused() + impl_->join_quota.Refused();
  counters.commands_strangers = impl_->command_owners.Refused() + impl_->strangers;
  counters.orders_refused = impl_->order_ids.Refused();
  counters.command_latency = impl_->command_latency_us.Summary();
  return counters;
}

}  // namespace giveway::link

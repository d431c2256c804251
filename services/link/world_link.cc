#include "services/link/world_link.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/anchored_reader.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/inbox/join_inbox.h"
#include "services/link/inbox/peer_events.h"
#include "services/link/participant.h"
#include "services/link/resolved_values.h"
#include "services/link/roster_outbox.h"
#include "services/link/vehicle_writers.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

constexpr std::uint32_t kForgetEvery = 32;  // turns; of vehicles that are gone

constexpr std::size_t kMostRefusals = 8;  // kept for the log; the counters have all

bool IsFinite(const MotorCommand& command) {
  return std::isfinite(command.target.left_rad_s) && std::isfinite(command.target.right_rad_s);
}

}  // namespace

struct WorldLink::Impl {
  explicit Impl(const LinkOptions& options)
      : participant(options, "giveway-world", names),
        joins(participant.MakeReader<wire::Join>("fleet")),
        command_reader(participant.MakeReader<wire::MotorCommand>(
            "v*", Participant::kProfileDepth, &events,
            dds::StatusMask::subscription_matched()
                << dds::StatusMask::requested_deadline_missed())),
        roster(participant.MakeWriter<wire::Roster>(kWorldPartition)),
        signal_writer(participant.MakeWriter<wire::SignalState>(kWorldPartition)),
        truth_writer(participant.MakeWriter<wire::Truth>(kWorldPartition)),
        event_writer(
            participant.MakeWriter<wire::Event>(kWorldPartition, EventDepth(options.fleet_size))),
        figures_writer(participant.MakeWriter<wire::Figures>(kWorldPartition)),
        order_reader(participant.MakeReader<wire::Order>(VehiclePartition(kNobody))),
        answer_writer(participant.MakeWriter<wire::Answer>(VehiclePartition(kNobody))),
        vehicles(names, participant.Prefix(), ""),
        command_wait(command_reader.Entity()) {}

  void FollowDiscovery() {
    const auto queued = events.Take();  // before the names, see VehicleLink::Take
    names.Update();
    discarded.clear();
    vehicles.Translate(queued, SteadyTime{0}, discarded);
  }
  void Receive(const wire::MotorCommand& sample, const dds::SampleInfo& info);
  void ForgetDeparted();
  template <typename Scan>
  void Send(const Scan& scan);
  void NoteRefusal(Refusal refusal) {
    if (refusals.size() < kMostRefusals) refusals.push_back(std::move(refusal));
  }
  void CountWrite(bool written) { counters.write_failures += written ? 0 : 1; }

  WriterNames names;  // the library calls these two until the participant is gone, so they are
  ReaderEvents events{&RemoveDeparted<wire::MotorCommand>};  // declared before it
  Participant participant;
  JoinInbox joins;
  AnchoredReader<wire::MotorCommand> command_reader;
  RosterOutbox roster;
  Writer<wire::SignalState> signal_writer;
  Writer<wire::Truth> truth_writer;
  Writer<wire::Event> event_writer;
  Writer<wire::Figures> figures_writer;
  Reader<wire::Order> order_reader;
  Writer<wire::Answer> answer_writer;
  std::unordered_map<VehicleId, VehicleWriters> writers;
  PeerEvents vehicles;  // by their command writers
  DataWait command_wait;
  std::vector<MotorCommand> commands;
  std::vector<QosEvent> discarded;
  std::vector<Refusal> refusals;
  WorldLinkCounters counters;
  std::uint32_t turns = 0;
};

void WorldLink::Impl::Receive(const wire::MotorCommand& sample, const dds::SampleInfo& info) {
  ++counters.commands_taken;
  const WriterEntry* const entry = names.Find(info.sample_identity.writer_guid());
  MotorCommand command;
  if (entry == nullptr) {
    ++counters.commands_unbound;
  } else if (entry->vehicle == kNobody || entry->vehicle != VehicleId{sample.vehicle()}) {
    ++counters.commands_wrong_name;
    const std::string wanted =
        entry->vehicle == kNobody ? "none" : std::to_string(Number(entry->vehicle));
    NoteRefusal({.sample = "motor command",
                 .vehicle = VehicleId{sample.vehicle()},
                 .writer = entry->identity,
                 .counter = "commands_wrong_name",
                 .field = "vehicle",
                 .why = "vehicle is " + std::to_string(sample.vehicle()) +
                        ", and its writer's partition names " + wanted + ": must be v" +
                        std::to_string(sample.vehicle())});
  } else if (!FromWire(sample, command) || !IsFinite(command)) {
    ++counters.commands_not_finite;
    const FieldFault fault = FaultOf(sample);
    NoteRefusal({.sample = "motor command",
                 .vehicle = entry->vehicle,
                 .writer = entry->identity,
                 .counter = "commands_not_finite",
                 .field = fault.field,
                 .why = Describe(fault)});
  } else {
    commands.push_back(command);
  }
}

WorldLink::WorldLink(const LinkOptions& options) : impl_(std::make_unique<Impl>(options)) {}
WorldLink::~WorldLink() = default;

std::string WorldLink::ParticipantText() const { return impl_->participant.PrefixText(); }

std::string WorldLink::WhyNobodyIsFound() const { return impl_->participant.WhyNobodyIsFound(); }

template <typename Scan>
void WorldLink::Impl::Send(const Scan& scan) {
  const auto found = writers.find(scan.vehicle);
  GIVEWAY_CHECK(found != writers.end(), Number(scan.vehicle));
  CountWrite(found->second.Write(ToWire(scan)));
}

void WorldLink::OpenVehicle(VehicleId vehicle, const VehicleProfile& profile) {
  GIVEWAY_CHECK(vehicle != kNobody);
  impl_->writers.try_emplace(vehicle, impl_->participant, vehicle, profile);
}

void WorldLink::CloseVehicle(VehicleId vehicle) {
  impl_->writers.erase(vehicle);
  impl_->roster.Retire(vehicle);
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
  impl_->FollowDiscovery();
  return impl_->joins.Take(impl_->names, impl_->refusals);
}

// Of a reader with a deadline its listener removes them, which alone knows when it may.
void WorldLink::Impl::ForgetDeparted() {
  if (++turns % kForgetEvery != 0) return;
  if (NanosecondsOf(command_reader.Entity().get_qos().deadline().period) == kInfiniteDuration) {
    RemoveDeparted<wire::MotorCommand>(command_reader.Entity(), dds::HANDLE_NIL);
  }
}

std::span<const MotorCommand> WorldLink::TakeCommands() {
  impl_->FollowDiscovery();
  impl_->ForgetDeparted();
  impl_->commands.clear();
  impl_->command_reader.TakeEach(
      [&](const wire::MotorCommand& sample, const dds::SampleInfo& info) {
        impl_->Receive(sample, info);
      });
  return impl_->commands;
}

std::vector<Refusal> WorldLink::TakeRefusals() { return std::exchange(impl_->refusals, {}); }

std::vector<std::string> WorldLink::TakeUnfit(SteadyTime now) {
  return impl_->participant.TakeUnfit(now);
}

bool WorldLink::WaitForCommands(Nanoseconds timeout) { return impl_->command_wait.Wait(timeout); }

void WorldLink::SendRoster(const RosterEntry& entry) {
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

std::vector<AdminOrder> WorldLink::TakeOrders() {
  std::vector<AdminOrder> orders;
  impl_->order_reader.TakeEach([&](const wire::Order& sample, const dds::SampleInfo&) {
    AdminOrder order;
    if (FromWire(sample, order)) orders.push_back(std::move(order));
  });
  return orders;
}

void WorldLink::SendAnswer(const AdminAnswer& answer) {
  impl_->CountWrite(impl_->answer_writer.Write(ToWire(answer)));
}

void WorldLink::FlushAnswer(Nanoseconds timeout) { impl_->answer_writer.WaitUntilHeard(timeout); }

std::vector<LiveValue> WorldLink::LiveQos() const { return impl_->participant.LiveQos(); }

bool WorldLink::SetDeadline(const std::string& profile, std::int64_t deadline) {
  return impl_->participant.SetDeadline(profile, ToDuration(deadline));
}

void WorldLink::Flush(Nanoseconds timeout) {
  // Where a reader has died without a word every one of them waits in vain, and all the while the
  // others are heard: so the time is one for all.
  const auto until = std::chrono::steady_clock::now() + timeout;
  impl_->roster.WaitUntilHeard(until);
  impl_->event_writer.WaitUntilHeard(until);
  impl_->figures_writer.WaitUntilHeard(until);
}

WorldLinkCounters WorldLink::Counters() const {
  WorldLinkCounters counters = impl_->counters;
  counters.joins_refused = impl_->joins.Refused();
  return counters;
}

}  // namespace giveway::link

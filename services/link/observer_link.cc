#include "services/link/observer_link.h"

#include <initializer_list>
#include <utility>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/interface_watch.h"
#include "services/link/inbox/beacon_inbox.h"
#include "services/link/inbox/participant_of.h"
#include "services/link/inbox/tick_period.h"
#include "services/link/participant.h"
#include "services/link/participant_names.h"

namespace giveway::link {
namespace {

constexpr std::int32_t kBeaconDepth = 32;  // an observer that looks once a second misses none

LinkOptions OfAnObserver(LinkOptions options) {
  options.requests_no_times = true;  // its vehicles' silence is theirs to judge
  return OfAllBodies(std::move(options));
}

}  // namespace

struct ObserverLink::Impl {
  Impl(const LinkOptions& given, Ranges given_ranges, Commands given_commands)
      : options(given),
        ranges(given_ranges),
        commands(given_commands),
        participant(OfAnObserver(options), "giveway-observer", names),
        status_reader(participant.MakeReader<wire::Status>("v*", &status_owners)),
        beacons(participant.MakeReader<wire::Beacon>(options.area + "/*", kBeaconDepth, nullptr,
                                                     dds::StatusMask::none(), &beacon_ids),
                names.Writers(), participant.Prefix()),
        truth_reader(participant.MakeReader<wire::Truth>(kWorldPartition, &worlds)),
        event_reader(participant.MakeReader<wire::Event>(kWorldPartition,
                                                         EventDepth(options.fleet_size), nullptr,
                                                         dds::StatusMask::none(), &worlds)),
        roster_reader(participant.MakeReader<wire::Roster>(kWorldPartition, &worlds)),
        signal_reader(participant.MakeReader<wire::SignalState>(kWorldPartition, &worlds)),
        figures_reader(participant.MakeReader<wire::Figures>(kWorldPartition, &worlds)) {
    if (ranges == Ranges::kYes) {
      ranges_reader = participant.MakeReader<wire::RangeScan>("v*", &worlds);
    }
    if (commands == Commands::kYes) {
      commands_reader = participant.MakeReader<wire::MotorCommand>("v*", &command_owners);
    }
  }

  // Appends every sample of a vehicle that its own participant wrote, and that this build can read.
  template <typename Wire, typename Ours>
  void AppendOwn(Reader<Wire>& reader, FirstComerFilter& owners, std::vector<Ours>& list,
                 Observed& observed) {
    reader.TakeEach([&](const Wire& sample, const dds::SampleInfo& info) {
      const rtps::GUID_t& writer = info.sample_identity.writer_guid();
      const WriterEntry* const entry = names.Writers().Find(writer);
      Ours value;
      if (entry == nullptr || entry->vehicle == kNoVehicle ||
          entry->vehicle != VehicleId{sample.vehicle()} ||
          !owners.Spoke(entry->vehicle, ParticipantOf(writer))) {
        ++observed.refused;
      } else if (FromWire(sample, value)) {
        list.push_back(std::move(value));
      }
    });
  }
  // Appends every sample of the world that this build can read.
  template <typename Wire, typename Ours>
  void Append(Reader<Wire>& reader, std::vector<Ours>& list, Observed& observed) {
    reader.TakeEach([&](const Wire& sample, const dds::SampleInfo& info) {
      Ours value;
      if (!worlds.Spoke(ParticipantOf(info.sample_identity.writer_guid()))) {
        ++observed.refused;
      } else if (FromWire(sample, value)) {
        list.push_back(std::move(value));
      }
    });
  }
  // Of a world whose ticks are slow, and of its vehicles, longer silences are none.
  void FollowTicks(const std::vector<Truth>& truths) {
    for (const Truth& truth : truths) tick_period.Hear(truth);
    worlds.SetTickPeriod(tick_period.Get());
    status_owners.SetTickPeriod(tick_period.Get());
    command_owners.SetTickPeriod(tick_period.Get());
  }
  void TakeRefusals(Observed& observed) {
    std::uint32_t refused = 0;
    for (SampleFilter* const filter : std::initializer_list<SampleFilter*>{
             &beacon_ids, &status_owners, &command_owners, &worlds}) {
      filter->TakeRefusals(&observed.refusals);
      refused += filter->Refused();
    }
    observed.refused += refused - std::exchange(refused_by_filters, refused);
  }

  const LinkOptions options;
  const Ranges ranges;
  const Commands commands;
  const InterfaceWatch interfaces{options.interface};  // before the participant binds to them
  ParticipantNames names;  // the library calls these two until the participant is gone
  KeyQuota beacon_ids{"beacon", KeyQuota::Key::kVehicle, KeyQuota::Of::kWriter, kMostIdsOfWriter};
  FirstComerFilter status_owners{"status"};
  FirstComerFilter command_owners{"motor command"};
  FirstWorldFilter worlds{"sample of a world",
                          [this](std::uint64_t one) { return names.IsWorld(one); }};
  TickPeriod tick_period;
  std::uint32_t refused_by_filters = 0;  // in Observed::refused so far
  Participant participant;
  Reader<wire::Status> status_reader;
  BeaconInbox beacons;
  Reader<wire::Truth> truth_reader;
  Reader<wire::Event> event_reader;
  Reader<wire::Roster> roster_reader;
  Reader<wire::SignalState> signal_reader;
  Reader<wire::Figures> figures_reader;
  std::optional<Reader<wire::RangeScan>> ranges_reader;
  std::optional<Reader<wire::MotorCommand>> commands_reader;
};

ObserverLink::ObserverLink(const LinkOptions& options, Ranges ranges, Commands commands)
    : impl_(std::make_unique<Impl>(options, ranges, commands)) {}
ObserverLink::~ObserverLink() = default;

void ObserverLink::RenewIfDeaf() {
  if (!impl_->participant.SharedMemoryIsGone()) return;
  given_ = last_event_;
  const LinkOptions options = WithoutSharedMemory(impl_->options);
  const Ranges ranges = impl_->ranges;
  const Commands commands = impl_->commands;
  impl_.reset();
  impl_ = std::make_unique<Impl>(options, ranges, commands);
}

// A world keeps its events for readers that join later, and so gives them to the new reader again.
void ObserverLink::DropGiven(std::vector<WorldEvent>* events) {
  std::erase_if(*events, [this](const WorldEvent& event) {
    return event.epoch == given_.epoch && event.seq <= given_.seq;
  });
  if (!events->empty()) last_event_ = {events->back().epoch, events->back().seq};
}

std::string ObserverLink::InterfaceChange() const { return impl_->interfaces.Change(); }

Observed ObserverLink::Take() {
  impl_->names.Writers().Update();
  Observed observed;
  observed.world = impl_->names.World();
  impl_->AppendOwn(impl_->status_reader, impl_->status_owners, observed.statuses, observed);
  impl_->beacons.Drain(SteadyTime{0}, observed.beacons);
  impl_->Append(impl_->truth_reader, observed.truths, observed);
  impl_->Append(impl_->event_reader, observed.events, observed);
  DropGiven(&observed.events);
  impl_->Append(impl_->roster_reader, observed.roster, observed);
  impl_->Append(impl_->signal_reader, observed.signals, observed);
  if (impl_->ranges_reader) impl_->Append(*impl_->ranges_reader, observed.ranges, observed);
  if (impl_->commands_reader) {
    impl_->AppendOwn(*impl_->commands_reader, impl_->command_owners, observed.commands, observed);
  }
  std::vector<RunFigures> figures;
  impl_->Append(impl_->figures_reader, figures, observed);
  if (!figures.empty()) observed.figures = figures.back();
  impl_->FollowTicks(observed.truths);
  impl_->TakeRefusals(observed);
  RenewIfDeaf();  // after what has come is taken
  return observed;
}

}  // namespace giveway::link

#include "services/link/observer_link.h"

#include "services/link/convert/convert.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/inbox/beacon_inbox.h"
#include "services/link/participant.h"
#include "services/link/participant_names.h"

namespace giveway::link {
namespace {

constexpr std::int32_t kBeaconDepth = 32;  // an observer that looks once a second misses none

// Appends every sample that this build can read.
template <typename Wire, typename Ours>
void Append(Reader<Wire>& reader, std::vector<Ours>& list) {
  reader.TakeEach([&](const Wire& sample, const dds::SampleInfo&) {
    Ours value;
    if (FromWire(sample, value)) list.push_back(std::move(value));
  });
}

}  // namespace

struct ObserverLink::Impl {
  Impl(const LinkOptions& options, Ranges ranges)
      : participant(options, "giveway-observer", names),
        status_reader(participant.MakeReader<wire::Status>("v*", &status_owners)),
        beacons(participant.MakeReader<wire::Beacon>(
                    options.area + "/*", kBeaconDepth, &beacon_events,
                    dds::StatusMask::requested_deadline_missed(), &beacon_ids),
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
  }

  void TakeStatuses(Observed& observed) {
    status_reader.TakeEach([&](const wire::Status& sample, const dds::SampleInfo& info) {
      const WriterEntry* const entry = names.Writers().Find(info.sample_identity.writer_guid());
      VehicleStatus status;
      if (entry == nullptr || entry->vehicle == kNobody ||
          entry->vehicle != VehicleId{sample.vehicle()}) {
        ++observed.refused;
      } else if (FromWire(sample, status)) {
        observed.statuses.push_back(status);
      }
    });
  }

  ParticipantNames names;  // the library calls these two until the participant is gone
  ReaderEvents beacon_events{&RemoveDeparted<wire::Beacon>};  // only to remove; its news go unread
  KeyQuota beacon_ids{"beacon", KeyQuota::Key::kVehicle, KeyQuota::Of::kWriter, kMostIdsOfWriter};
  FirstComerFilter status_owners{"status"};
  FirstWorldFilter worlds{"sample of a world",
                          [this](std::uint64_t one) { return names.IsWorld(one); }};
  Participant participant;
  Reader<wire::Status> status_reader;
  BeaconInbox beacons;
  Reader<wire::Truth> truth_reader;
  Reader<wire::Event> event_reader;
  Reader<wire::Roster> roster_reader;
  Reader<wire::SignalState> signal_reader;
  Reader<wire::Figures> figures_reader;
  std::optional<Reader<wire::RangeScan>> ranges_reader;
};

ObserverLink::ObserverLink(const LinkOptions& options, Ranges ranges)
    : impl_(std::make_unique<Impl>(options, ranges)) {}
ObserverLink::~ObserverLink() = default;

Observed ObserverLink::Take() {
  impl_->names.Writers().Update();
  Observed observed;
  impl_->TakeStatuses(observed);
  impl_->beacons.Drain(SteadyTime{0}, observed.beacons);
  Append(impl_->truth_reader, observed.truths);
  Append(impl_->event_reader, observed.events);
  Append(impl_->roster_reader, observed.roster);
  Append(impl_->signal_reader, observed.signals);
  if (impl_->ranges_reader) Append(*impl_->ranges_reader, observed.ranges);
  std::vector<RunFigures> figures;
  Append(impl_->figures_reader, figures);
  if (!figures.empty()) observed.figures = figures.back();
  return observed;
}

}  // namespace giveway::link

#include "services/link/discovery_probe.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "services/link/fastdds/anchored_reader.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/impairment/impairer.h"
#include "services/link/participant.h"

namespace giveway::link {
namespace {

// The first twelve bytes of the GUID of every entity of a participant.
using Prefix = std::array<std::uint8_t, 12>;

Prefix PrefixOf(const rtps::GUID_t& guid) {
  Prefix prefix;
  std::copy_n(guid.guidPrefix.value, prefix.size(), prefix.begin());
  return prefix;
}

using Processes = std::map<Prefix, ProbedProcess>;

ProbedProcess& ProcessOf(Processes& processes, const Prefix& prefix) {
  ProbedProcess& process = processes[prefix];
  std::ranges::copy(prefix, process.guid.begin());
  // Bytes 0 and 1 name the vendor.
  process.host_id = static_cast<std::uint16_t>(prefix[2] | prefix[3] << 8U);
  process.process = static_cast<std::uint16_t>(prefix[4] | prefix[5] << 8U);
  return process;
}

class Discovered final : public DiscoveryListener {
 public:
  void OnWriter(Change change, const rtps::GUID_t& writer,
                const std::vector<std::string>& partitions) override {
    if (change == Change::kGone) return;
    const std::scoped_lock lock(mutex_);
    found_.emplace_back(PrefixOf(writer), partitions);
  }
  void MoveTo(Processes& processes) {
    const std::scoped_lock lock(mutex_);
    for (const auto& [prefix, partitions] : found_) Note(ProcessOf(processes, prefix), partitions);
    found_.clear();
  }

 private:
  static void Note(ProbedProcess& process, const std::vector<std::string>& partitions) {
    const VehicleId named = NamedVehicle(partitions);
    if (named != kNoVehicle) process.vehicle = named;
    const std::vector<std::string> none{""};
    for (const std::string& partition : partitions.empty() ? none : partitions) {
      const auto known = std::ranges::find(process.partitions, partition);
      if (known == process.partitions.end()) process.partitions.push_back(partition);
    }
  }

  std::mutex mutex_;
  std::vector<std::pair<Prefix, std::vector<std::string>>> found_;  // guarded by mutex_
};

// The reader of one topic, whatever travels on it.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void Poll(Processes& processes) = 0;
};

template <typename Wire>
class TopicListener final : public Listener {
 public:
  TopicListener(Participant& participant, const std::string& partition)
      : reader_(participant.MakeReader<Wire>(partition, Participant::kProfileDepth, &events_,
                                             ReaderEvents::Mask())) {}

  void Poll(Processes& processes) override {
    for (const ReaderEvent& event : events_.Take().events) {
      if (event.kind == ReaderEvent::Kind::kMatched) {
        CountOf(processes, GuidOf(event.handle)).matched = true;
      }
    }
    reader_.TakeEach([&](const Wire&, const dds::SampleInfo& info) {
      ++CountOf(processes, info.sample_identity.writer_guid()).samples;
    });
  }

 private:
  static ProbedTopicCount& CountOf(Processes& processes, const rtps::GUID_t& writer) {
    return ProcessOf(processes, PrefixOf(writer)).topics[TopicOf<Wire>::kName];
  }

  ReaderEvents events_{&RemoveDeparted<Wire>};
  AnchoredReader<Wire> reader_;
};

template <typename... Wires>
std::unique_ptr<Listener> MakeListener(Participant& participant, const ProbeTopic& topic) {
  std::unique_ptr<Listener> made;
  const auto make_if = [&]<typename Wire>(const Wire*) {
    if (topic.name != TopicOf<Wire>::kName) return;
    made = std::make_unique<TopicListener<Wire>>(participant, topic.partition);
  };
  (make_if(static_cast<const Wires*>(nullptr)), ...);
  if (made == nullptr) throw LinkError("no probe for the topic " + topic.name);
  return made;
}

std::unique_ptr<Listener> MakeAnyListener(Participant& participant, const ProbeTopic& topic) {
  return MakeListener<wire::Beacon, wire::MotorCommand, wire::Join, wire::RangeScan,
                      wire::RadarScan, wire::LidarScan, wire::CameraScan, wire::PoseFix,
                      wire::Roster, wire::SignalState>(participant, topic);
}

}  // namespace

struct DiscoveryProbe::Impl {
  Impl(const LinkOptions& options, const std::vector<ProbeTopic>& topics, VehicleId hearer)
      : participant(options, "giveway-probe", discovered, Participant::Endpoints::kJudged) {
    if (Impairer* const impairer = participant.ImpairerOrNull()) impairer->NameHearer(hearer);
    for (const ProbeTopic& topic : topics) listeners.push_back(MakeAnyListener(participant, topic));
  }

  Processes processes;
  Discovered discovered;  // the library calls these two until the participant is gone
  std::vector<std::unique_ptr<Listener>> listeners;
  Participant participant;
};

DiscoveryProbe::DiscoveryProbe(const LinkOptions& options, const std::vector<ProbeTopic>& topics,
                               VehicleId hearer)
    : impl_(std::make_unique<Impl>(options, topics, hearer)) {}
DiscoveryProbe::~DiscoveryProbe() = default;

void DiscoveryProbe::StartImpairment(SteadyTime start) {
  if (Impairer* const impairer = impl_->participant.ImpairerOrNull()) impairer->Start(start);
}

std::vector<std::string> DiscoveryProbe::TakeUnfit(SteadyTime now) {
  return impl_->participant.TakeUnfit(now);
}

std::vector<ProbedProcess> DiscoveryProbe::Poll() {
  impl_->discovered.MoveTo(impl_->processes);
  for (const FoundEndpoint& found : impl_->participant.TakeFound()) {
    Prefix prefix;
    std::copy_n(found.guid.begin(), prefix.size(), prefix.begin());
    auto& known = ProcessOf(impl_->processes, prefix).endpoints;
    std::erase_if(known, [&](const FoundEndpoint& one) { return one.guid == found.guid; });
    known.push_back(found);
  }
  for (const auto& listener : impl_->listeners) listener->Poll(impl_->processes);
  std::vector<ProbedProcess> all;
  for (const auto& [prefix, process] : impl_->processes) all.push_back(process);
  return all;
}

}  // namespace giveway::link

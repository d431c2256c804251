#include "services/link/raw_link.h"

#include <functional>

#include "services/link/fastdds/raw_type.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/participant.h"

namespace giveway::link {

// A topic's raw readers take the profile of its decoded ones.
template <typename Wire>
struct RawTopicOf {
  static constexpr const char* kName = TopicOf<Wire>::kName;
  static constexpr const char* kReader = TopicOf<Wire>::kReader;
  static constexpr std::size_t kKeyNumbers = TopicOf<Wire>::kKeyNumbers;
};

#define GIVEWAY_RAW_TOPIC(wire_type)                                    \
  template <>                                                           \
  struct TopicOf<Raw<wire::wire_type>> : RawTopicOf<wire::wire_type> {  \
    using Type = RawType<wire::wire_type, wire::wire_type##PubSubType>; \
  }

GIVEWAY_RAW_TOPIC(Beacon);
GIVEWAY_RAW_TOPIC(MotorCommand);
GIVEWAY_RAW_TOPIC(Status);
GIVEWAY_RAW_TOPIC(Join);
GIVEWAY_RAW_TOPIC(RangeScan);
GIVEWAY_RAW_TOPIC(RadarScan);
GIVEWAY_RAW_TOPIC(LidarScan);
GIVEWAY_RAW_TOPIC(CameraScan);
GIVEWAY_RAW_TOPIC(Roster);
GIVEWAY_RAW_TOPIC(SignalState);
GIVEWAY_RAW_TOPIC(Truth);
GIVEWAY_RAW_TOPIC(Event);
GIVEWAY_RAW_TOPIC(Figures);

#undef GIVEWAY_RAW_TOPIC

namespace {

constexpr std::int32_t kRawDepth = 32;  // of each vehicle: a recorder may stand still for a second
constexpr char kAllVehicles[] = "v*";
constexpr char kFleetPartition[] = "fleet";

template <typename Time>  // which of its two the library takes here depends on its release
std::uint64_t SinceEpoch_ns(const Time& time) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(time.to_ns(), 0));
}

using Drain = std::function<void(std::vector<RawSample>&)>;

struct OpenTopic {
  Drain drain;
  const dds::DataReader* reader = nullptr;
};

template <typename Wire>
OpenTopic OpenAs(Participant& participant, std::size_t topic, const std::string& partition,
                 std::int32_t depth) {
  Reader<Raw<Wire>> reader = participant.MakeReader<Raw<Wire>>(partition, depth);
  const auto drain = [reader, topic](std::vector<RawSample>& samples) mutable {
    reader.TakeEach([&](const Raw<Wire>& raw, const dds::SampleInfo& info) {
      const auto sequence = info.sample_identity.sequence_number().to64long();
      samples.push_back({topic, SinceEpoch_ns(info.source_timestamp),
                         SinceEpoch_ns(info.reception_timestamp),
                         static_cast<std::uint32_t>(sequence), raw.bytes});
    });
  };
  return {drain, &reader.Entity()};
}

using Open = OpenTopic (*)(Participant&, std::size_t, const LinkOptions&);

template <typename Wire>
OpenTopic OpenOfVehicles(Participant& participant, std::size_t topic, const LinkOptions&) {
  return OpenAs<Wire>(participant, topic, kAllVehicles, kRawDepth);
}
template <typename Wire>
OpenTopic OpenOfWorld(Participant& participant, std::size_t topic, const LinkOptions&) {
  return OpenAs<Wire>(participant, topic, kWorldPartition, kRawDepth);
}
OpenTopic OpenBeacons(Participant& participant, std::size_t topic, const LinkOptions& options) {
  return OpenAs<wire::Beacon>(participant, topic, options.area + "/*", kRawDepth);
}
OpenTopic OpenJoins(Participant& participant, std::size_t topic, const LinkOptions&) {
  return OpenAs<wire::Join>(participant, topic, kFleetPartition, Participant::kProfileDepth);
}
OpenTopic OpenEvents(Participant& participant, std::size_t topic, const LinkOptions& options) {
  return OpenAs<wire::Event>(participant, topic, kWorldPartition, EventDepth(options.fleet_size));
}
// Reliable, and few: as its profile says.
template <typename Wire>
OpenTopic OpenAsProfiled(Participant& participant, std::size_t topic, const LinkOptions&) {
  return OpenAs<Wire>(participant, topic, kWorldPartition, Participant::kProfileDepth);
}

struct KnownTopic {
  RawTopic topic;
  Open open;
};

const std::vector<KnownTopic>& Known() {
  static const std::vector<KnownTopic> known{
      {{"fleet/beacon", "giveway::wire::Beacon"}, OpenBeacons},
      {{"fleet/motor_command", "giveway::wire::MotorCommand"}, OpenOfVehicles<wire::MotorCommand>},
      {{"fleet/status", "giveway::wire::Status"}, OpenOfVehicles<wire::Status>},
      {{"fleet/join", "giveway::wire::Join"}, OpenJoins},
      {{"world/ranges", "giveway::wire::RangeScan"}, OpenOfVehicles<wire::RangeScan>},
      {{"world/radar", "giveway::wire::RadarScan"}, OpenOfVehicles<wire::RadarScan>},
      {{"world/lidar", "giveway::wire::LidarScan"}, OpenOfVehicles<wire::LidarScan>},
      {{"world/camera", "giveway::wire::CameraScan"}, OpenOfVehicles<wire::CameraScan>},
      {{"world/roster", "giveway::wire::Roster"}, OpenAsProfiled<wire::Roster>},
      {{"world/signal", "giveway::wire::SignalState"}, OpenAsProfiled<wire::SignalState>},
      {{"world/truth", "giveway::wire::Truth"}, OpenOfWorld<wire::Truth>},
      {{"world/event", "giveway::wire::Event"}, OpenEvents},
      {{"world/figures", "giveway::wire::Figures"}, OpenAsProfiled<wire::Figures>},
  };
  return known;
}

std::string DurationText(const Duration& duration) {
  const double ms = ToMilliseconds(duration);
  return ms > 1e9 ? "none" : std::to_string(static_cast<std::int64_t>(ms)) + " ms";
}

}  // namespace

const std::vector<RawTopic>& RawTopics() {
  static const std::vector<RawTopic> topics = [] {
    std::vector<RawTopic> names;
    for (const KnownTopic& known : Known()) names.push_back(known.topic);
    return names;
  }();
  return topics;
}

struct RawLink::Impl {
  explicit Impl(const LinkOptions& options) : participant(options, "giveway-recorder", names) {}

  WriterNames names;  // the library calls it until the participant is gone
  Participant participant;
  std::vector<std::pair<std::size_t, OpenTopic>> open;
};

RawLink::RawLink(const LinkOptions& options, const std::vector<std::size_t>& topics)
    : impl_(std::make_unique<Impl>(options)) {
  for (const std::size_t topic : topics) {
    impl_->open.emplace_back(topic, Known().at(topic).open(impl_->participant, topic, options));
  }
}
RawLink::~RawLink() = default;

void RawLink::Collect() {
  impl_->names.Update();
  for (const auto& [topic, open] : impl_->open) open.drain(samples_);
}

std::string RawLink::QosText(std::size_t topic) const {
  for (const auto& [number, open] : impl_->open) {
    if (number != topic) continue;
    const auto& qos = open.reader->get_qos();
    return std::string(qos.reliability().kind == dds::RELIABLE_RELIABILITY_QOS ? "RELIABLE"
                                                                               : "BEST_EFFORT") +
           (qos.durability().kind == dds::VOLATILE_DURABILITY_QOS ? ", VOLATILE"
                                                                  : ", TRANSIENT_LOCAL") +
           ", deadline " + DurationText(qos.deadline().period);
  }
  return {};
}

}  // namespace giveway::link

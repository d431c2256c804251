#include "services/link/raw_link.h"

#include <algorithm>
#include <functional>
#include <type_traits>

#include "services/link/fastdds/raw_type.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/inbox/given_samples.h"
#include "services/link/participant.h"

namespace giveway::link {

// A topic's raw readers take the profile of its decoded ones.
template <typename Wire>
struct RawTopicOf {
  static constexpr const char* kName = TopicOf<Wire>::kName;
  static constexpr const char* kReader = TopicOf<Wire>::kReader;
  static constexpr std::size_t kKeyNumbers = TopicOf<Wire>::kKeyNumbers;
};

#define GIVEWAY_RAW_TOPIC(wire_type, name, profile, key_numbers)        \
  template <>                                                           \
  struct TopicOf<Raw<wire::wire_type>> : RawTopicOf<wire::wire_type> {  \
    using Type = RawType<wire::wire_type, wire::wire_type##PubSubType>; \
  };
GIVEWAY_TOPICS(GIVEWAY_RAW_TOPIC)
#undef GIVEWAY_RAW_TOPIC

namespace {

constexpr std::int32_t kRawDepth = 32;  // of each vehicle: a recorder may stand still for a second
constexpr char kAllVehicles[] = "v*";
constexpr char kFleetPartition[] = "fleet";

template <typename Time>  // which of its two the library takes here depends on its release
std::uint64_t SinceEpoch_ns(const Time& time) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(time.to_ns(), 0));
}

using Drain = std::function<void(GivenSamples&, std::vector<RawSample>&)>;

struct DrainedReader {
  Drain drain;
  const dds::DataReader* reader = nullptr;
};

std::array<std::uint8_t, 16> InstanceOf(const dds::InstanceHandle_t& handle) {
  std::array<std::uint8_t, 16> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = handle.value[i];
  return bytes;
}

bool KeepsForLateReaders(const dds::DataReader& reader) {
  return reader.get_qos().durability().kind != dds::VOLATILE_DURABILITY_QOS;
}

template <typename Wire>
DrainedReader OpenAs(Participant& participant, std::size_t topic, const std::string& partition,
                     std::int32_t depth) {
  Reader<Raw<Wire>> reader = participant.MakeReader<Raw<Wire>>(partition, depth);
  const bool is_durable = KeepsForLateReaders(reader.Entity());
  const auto drain = [reader, topic, is_durable](GivenSamples& given,
                                                 std::vector<RawSample>& samples) mutable {
    reader.TakeEach([&](const Raw<Wire>& raw, const dds::SampleInfo& info) {
      const auto sequence = info.sample_identity.sequence_number().to64long();
      if (is_durable && given.IsGivenAgain(topic, Identity(info.sample_identity.writer_guid()),
                                           static_cast<std::uint64_t>(sequence))) {
        return;
      }
      samples.push_back(
          {topic, SinceEpoch_ns(info.source_timestamp), SinceEpoch_ns(info.reception_timestamp),
           static_cast<std::uint32_t>(sequence), raw.bytes, InstanceOf(info.instance_handle)});
    });
  };
  return {drain, &reader.Entity()};
}

using OpenReader = DrainedReader (*)(Participant&, std::size_t, const LinkOptions&);

struct Where {
  std::string partition;
  std::int32_t depth;
};

// By the type of the topic: one without a line here does not compile.
Where Of(const wire::Beacon*, const LinkOptions& options) {
  return {options.area + "/*", kRawDepth};
}
Where Of(const wire::MotorCommand*, const LinkOptions&) { return {kAllVehicles, kRawDepth}; }
Where Of(const wire::Status*, const LinkOptions&) { return {kAllVehicles, kRawDepth}; }
Where Of(const wire::Join*, const LinkOptions&) {
  return {kFleetPartition, Participant::kProfileDepth};
}
Where Of(const wire::RangeScan*, const LinkOptions&) { return {kAllVehicles, kRawDepth}; }
Where Of(const wire::RadarScan*, const LinkOptions&) { return {kAllVehicles, kRawDepth}; }
Where Of(const wire::LidarScan*, const LinkOptions&) { return {kAllVehicles, kRawDepth}; }
Where Of(const wire::CameraScan*, const LinkOptions&) { return {kAllVehicles, kRawDepth}; }
Where Of(const wire::PoseFix*, const LinkOptions&) { return {kAllVehicles, kRawDepth}; }
Where Of(const wire::Truth*, const LinkOptions&) { return {kWorldPartition, kRawDepth}; }
Where Of(const wire::Event*, const LinkOptions& options) {
  return {kWorldPartition, EventDepth(options.fleet_size)};
}
// Reliable, and few: as the profile says.
Where Of(const wire::Roster*, const LinkOptions&) {
  return {kWorldPartition, Participant::kProfileDepth};
}
Where Of(const wire::SignalState*, const LinkOptions&) {
  return {kWorldPartition, Participant::kProfileDepth};
}
Where Of(const wire::Figures*, const LinkOptions&) {
  return {kWorldPartition, Participant::kProfileDepth};
}

template <typename Wire>
DrainedReader OpenRaw(Participant& participant, std::size_t topic, const LinkOptions& options) {
  const Where where = Of(static_cast<const Wire*>(nullptr), options);
  return OpenAs<Wire>(participant, topic, where.partition, where.depth);
}

struct KnownTopic {
  RawTopic topic;
  OpenReader open;
};

// Orders and answers carry what is between an operator and a vehicle.
template <typename Wire>
constexpr bool kIsRecorded =
    !std::is_same_v<Wire, wire::Order> && !std::is_same_v<Wire, wire::Answer>;

template <typename Wire>
void AddTopic(std::vector<KnownTopic>* known) {
  if constexpr (kIsRecorded<Wire>) {
    known->push_back({{TopicOf<Wire>::kName, TopicOf<Wire>::kType, TopicOf<Wire>::kKeyNumbers > 0},
                      OpenRaw<Wire>});
  }
}

const std::vector<KnownTopic>& Known() {
  static const std::vector<KnownTopic> known = [] {
    std::vector<KnownTopic> all;
#define GIVEWAY_ADD_TOPIC(wire_type, name, profile, key_numbers) AddTopic<wire::wire_type>(&all);
    GIVEWAY_TOPICS(GIVEWAY_ADD_TOPIC)
#undef GIVEWAY_ADD_TOPIC
    return all;
  }();
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

struct RawLink::OpenTopic {
  std::size_t topic = 0;
  DrainedReader reader;
};

struct RawLink::Impl {
  explicit Impl(const LinkOptions& given)
      : options(given), participant(OfAllBodies(given), "giveway-recorder", names) {}

  const LinkOptions options;
  WriterNames names;  // the library calls it until the participant is gone
  Participant participant;
  std::vector<OpenTopic> open;
};

RawLink::RawLink(const LinkOptions& options, const std::vector<std::size_t>& topics)
    : given_(std::make_unique<GivenSamples>()), impl_(std::make_unique<Impl>(options)) {
  for (const std::size_t topic : topics) Open(topic);
}
RawLink::~RawLink() = default;

// As ObserverLink.
void RawLink::RenewIfDeaf() {
  if (!impl_->participant.SharedMemoryIsGone()) return;
  const LinkOptions options = WithoutSharedMemory(impl_->options);
  std::vector<std::size_t> topics;
  for (const OpenTopic& open : impl_->open) topics.push_back(open.topic);
  given_->Renew();
  impl_.reset();
  impl_ = std::make_unique<Impl>(options);
  for (const std::size_t topic : topics) Open(topic);
}

void RawLink::Collect() {
  impl_->names.Update();
  for (const OpenTopic& open : impl_->open) open.reader.drain(*given_, samples_);
  RenewIfDeaf();
}

void RawLink::Open(std::size_t topic) {
  if (Find(topic) != nullptr) return;
  impl_->open.push_back({topic, Known().at(topic).open(impl_->participant, topic, impl_->options)});
}

const RawLink::OpenTopic* RawLink::Find(std::size_t topic) const {
  const auto open = std::ranges::find(impl_->open, topic, &OpenTopic::topic);
  return open == impl_->open.end() ? nullptr : &*open;
}

bool RawLink::IsDurable(std::size_t topic) const {
  const OpenTopic* open = Find(topic);
  return open != nullptr && KeepsForLateReaders(*open->reader.reader);
}

std::string RawLink::QosText(std::size_t topic) const {
  const OpenTopic* open = Find(topic);
  if (open == nullptr) return {};
  const auto& qos = open->reader.reader->get_qos();
  return std::string(qos.reliability().kind == dds::RELIABLE_RELIABILITY_QOS ? "RELIABLE"
                                                                             : "BEST_EFFORT") +
         (qos.durability().kind == dds::VOLATILE_DURABILITY_QOS ? ", VOLATILE"
                                                                : ", TRANSIENT_LOCAL") +
         ", deadline " + DurationText(qos.deadline().period);
}

}  // namespace giveway::link

#include "services/link/ros2/ros2_link.h"

#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "services/link/participant.h"
#include "services/link/ros2/ros2_types.h"
#include "services/ros2/definitions.h"

namespace giveway::link {
namespace {

const Duration kHeartbeat(0, 100'000'000);  // as the fleet's reliable writers

// In code and not in the profile set: these are ROS 2's, a reader there asks for no other.
dds::DataWriterQos QosOf(const std::string& topic) {
  const ros2::Offer offer = ros2::OfferOf(topic);
  dds::DataWriterQos qos;
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = Duration(0, 0);
  qos.durability().kind =
      offer.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = offer.depth;
  qos.resource_limits().max_samples = offer.depth;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = offer.depth;
  qos.resource_limits().allocated_samples = 1;
  qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
  qos.data_sharing().off();
  // By its bounds a message is megabytes: memory is taken for what is written.
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  SetHeartbeatPeriod(qos, kHeartbeat);
  qos.writer_resource_limits().reader_filters_allocation.maximum = 0;  // a stranger's expressions
  return qos;
}

// What others publish is of no interest here.
class NoInterest final : public DiscoveryListener {
 public:
  void OnWriter(Change, const rtps::GUID_t&, const std::vector<std::string>&) override {}
};

template <typename Wire>
std::string Serialized(Wire sample) {
  typename Ros2Support<Wire>::Type type;
  rtps::SerializedPayload_t payload(SerializedSize(type, &sample));
  if (!Serialize(type, &sample, payload)) return {};
  return {reinterpret_cast<const char*>(payload.data), payload.length};
}

}  // namespace

struct Ros2Link::Impl {
  explicit Impl(const LinkOptions& options) : participant(options, "giveway-ros2", discovery) {}

  template <typename Wire>
  dds::DataWriter& WriterOf(const std::string& topic) {
    const auto known = writers.find(topic);
    if (known != writers.end()) return *known->second;
    dds::DataWriter& writer = participant.MakeForeignWriter(
        dds::TypeSupport(new typename Ros2Support<Wire>::Type), "rt" + topic, QosOf(topic));
    writers.emplace(topic, &writer);
    return writer;
  }

  NoInterest discovery;  // the library calls it until the participant is gone
  Participant participant;
  std::map<std::string, dds::DataWriter*> writers;  // by the topic's name in ROS
};

// Over UDP alone: ROS 2's programs start when they like, and one that starts after shared memory
// was deleted would not receive it.
Ros2Link::Ros2Link(const LinkOptions& options)
    : impl_(std::make_unique<Impl>(WithoutSharedMemory(options))) {}
Ros2Link::~Ros2Link() = default;

bool Ros2Link::Write(const ros2::Message& message) {
  const auto write = [&](const auto& body) {
    auto wire = ToWire(body);
    return Ok(impl_->WriterOf<decltype(wire)>(message.topic).write(&wire));
  };
  try {
    return std::visit(write, message.body);
  } catch (const LinkError&) {
    return false;
  }
}

void Ros2Link::Close(const std::string& name_space) {
  std::erase_if(impl_->writers, [&](const auto& known) {
    if (!known.first.starts_with(name_space)) return false;
    impl_->participant.Delete(*known.second);
    return true;
  });
}

std::string Encode(const ros2::Message& message) {
  return std::visit([](const auto& body) { return Serialized(ToWire(body)); }, message.body);
}

}  // namespace giveway::link

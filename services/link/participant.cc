#include "services/link/participant.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "services/link/fastdds/dropped_writers.h"
#include "services/link/fastdds/filtered_transport.h"
#include "services/link/fastdds/interfaces.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/profiles.h"
#include "services/link/fastdds/server_addresses.h"
#include "services/link/impairment/impaired_transport.h"
#include "services/link/link_clock.h"

namespace giveway::link {
namespace {

constexpr char kParticipantProfile[] = "giveway_participant";
// Announcements cost N^2 packets a period, so a large fleet announces itself more rarely.
constexpr std::uint32_t kLargeFleet = 32;
const Duration kLargeFleetLease{20, 0};
const Duration kLargeFleetAnnouncement{5, 0};

bool IsAreaName(std::string_view name) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789_-";
  return !name.empty() && name.size() <= 64 &&
         name.find_first_not_of(kAllowed) == std::string_view::npos;
}

void CheckOptions(const LinkOptions& options) {
  if (options.domain < 1 || options.domain > 99) {
    throw LinkError("domain " + std::to_string(options.domain) +
                    ": must be 1 to 99; above 101 its ports collide with ephemeral ones");
  }
  if (!IsAreaName(options.area)) {
    throw LinkError("area \"" + options.area + "\": must be 1 to 64 of a-z 0-9 _ -");
  }
}

bool IsLoopback(const std::string& interface) {
  const std::vector<std::string> addresses = ResolveInterface(interface);
  return !addresses.empty() && std::ranges::all_of(addresses, [](const std::string& address) {
    return address.starts_with("127.");
  });
}

bool IsSecured(const dds::DomainParticipantQos& qos) {
  return std::ranges::any_of(qos.properties().properties(), [](const auto& property) {
    return property.name() == "dds.sec.auth.plugin";
  });
}

// Where the library would keep records of writers dropped for their lease: whether all that a
// participant says, and its announcements by itself, pass the transport; and the library may be
// made to remove one just when others are found, as farewells do.
// The call of ForgetsDroppedWriters is what links that file in, and with it what it puts in front
// of the library's.
bool SaysFarewell(const LinkOptions& options, const dds::DomainParticipantQos& qos) {
  const auto& discovery = qos.wire_protocol().builtin.discovery_config;
  return !ForgetsDroppedWriters() && kRemovesWhileItSends && options.discovery_servers.empty() &&
         discovery.discoveryProtocol == Discovery::SIMPLE &&
         qos.transport().user_transports.size() == 1;
}

FilteredTransportOptions FilterOf(const LinkOptions& options,
                                  const dds::DomainParticipantQos& qos) {
  return {.filter = {.largest_sample = LargestSample(),
                     .fleet_size = options.fleet_size,
                     .strangers = options.strangers,
                     .loopback_only = IsLoopback(options.interface),
                     .secured = IsSecured(qos),
                     .of_all_bodies = options.hears_all_bodies,
                     .seed = 0},
          .joined_interfaces_only = options.interface != "any",
          .says_farewell = SaysFarewell(options, qos),
          .lets_packets_gather = options.lets_packets_gather};
}

bool IsSharedMemory(const std::shared_ptr<transport::TransportDescriptorInterface>& named) {
  return dynamic_cast<transport::SharedMemTransportDescriptor*>(named.get()) != nullptr;
}

// UDP, and in addition shared memory if the profile names it and the options do not leave it out:
// the profile says how, the options say on which interfaces. Impaired if `impairer` is, and
// filtered behind that.
void SetTransport(dds::DomainParticipantQos& qos, const LinkOptions& options, bool filtered,
                  const std::shared_ptr<Impairer>& impairer) {
  auto& list = qos.transport().user_transports;
  if (options.leaves_out_shared_memory) std::erase_if(list, IsSharedMemory);
  const FilteredTransportOptions filter = FilterOf(options, qos);
  std::size_t udp_transports = 0;
  std::size_t shared_memories = 0;
  for (auto& named : list) {
    if (const auto* udp = dynamic_cast<transport::UDPv4TransportDescriptor*>(named.get())) {
      // A copy, because the profile's descriptor is shared by the whole process.
      auto own = std::make_shared<transport::UDPv4TransportDescriptor>(*udp);
      own->interfaceWhiteList = ResolveInterface(options.interface);
      named = own;
      if (impairer != nullptr) named = MakeImpairedTransport(own, impairer);
      if (filtered) named = MakeFilteredTransport(named, filter);
      ++udp_transports;
    } else if (IsSharedMemory(named)) {
      ++shared_memories;
    }
  }
  const bool others = udp_transports + shared_memories != list.size();
  if (udp_transports != 1 || others || qos.transport().use_builtin_transports) {
    throw LinkError("QoS file " + options.qos.name + ": profile \"" + kParticipantProfile +
                    "\" must switch useBuiltinTransports off and name one UDPv4 transport, and "
                    "in addition at most shared memory (SHM)");
  }
  if (impairer != nullptr && shared_memories != 0) {
    throw LinkError("QoS file " + options.qos.name + ": profile \"" + kParticipantProfile +
                    "\" names shared memory, which an impairment would not touch; take a set "
                    "that names UDPv4 alone");
  }
}

// That of `fast-discovery-server -i ID`.
rtps::GuidPrefix_t ServerPrefix(std::size_t id) {
  rtps::GuidPrefix_t prefix;
  const std::array<rtps::octet, 12> bytes{
      0x44, 0x53, static_cast<rtps::octet>(id), 0x5f, 0x45, 0x50, 0x52, 0x4f, 0x53, 0x49,
      0x4d, 0x41};
  std::ranges::copy(bytes, prefix.value);
  return prefix;
}

// Replaces the profile's discovery: all participants are found through these servers.
void SetDiscoveryServers(rtps::DiscoverySettings& discovery, const LinkOptions& options) {
  discovery.discoveryProtocol = Discovery::CLIENT;
  discovery.m_DiscoveryServers.clear();
  const FoundServers found = options.server_addresses.empty()
                                 ? FindServers(options.discovery_servers)
                                 : FoundServers{options.server_addresses, ""};
  if (!found.fault.empty()) throw LinkError(found.fault);
  for (const auto& [ipv4, port] : found.addresses) {
    rtps::Locator_t address;
    rtps::IPLocator::setIPv4(address, ipv4);
    rtps::IPLocator::setPhysicalPort(address, port);
    AddDiscoveryServer(discovery, ServerPrefix(discovery.m_DiscoveryServers.size()), address);
  }
}

dds::DomainParticipantQos MakeQos(const LinkOptions& options, const std::string& name,
                                  bool filtered, const std::shared_ptr<Impairer>& impairer) {
  dds::DomainParticipantQos qos;
  auto* factory = dds::DomainParticipantFactory::get_instance();
  if (!Ok(factory->get_participant_qos_from_profile(kParticipantProfile, qos))) {
    ThrowMissingProfile(kParticipantProfile);
  }
  qos.name(name);
  SetTransport(qos, options, filtered, impairer);
  auto& discovery = qos.wire_protocol().builtin.discovery_config;
  if (!options.discovery_servers.empty()) {
    SetDiscoveryServers(discovery, options);
  }
  if (options.fleet_size > kLargeFleet) {
    discovery.leaseDuration = kLargeFleetLease;
    discovery.leaseDuration_announcementperiod = kLargeFleetAnnouncement;
  }
  return qos;
}

// As the user named them; empty where participants are found by multicast.
std::string ServersOf(const dds::DomainParticipantQos& qos, const LinkOptions& options) {
  if (!options.discovery_servers.empty()) return ToText(options.discovery_servers);
  const auto& discovery = qos.wire_protocol().builtin.discovery_config;
  return discovery.discoveryProtocol == Discovery::CLIENT ? "those of " + options.qos.name : "";
}

[[noreturn]] void ThrowNotMade(const std::string& what) {
  throw LinkError("Fast DDS did not make the " + what + LibraryComplaints());
}

template <typename Qos>
void SetDepth(Qos& qos, std::int32_t depth) {
  if (depth != Participant::kProfileDepth) qos.history().depth = depth;
}

void RequestNoTimes(dds::DataReaderQos& qos) {
  qos.deadline().period = dds::DeadlineQosPolicy().period;
  qos.liveliness().lease_duration = dds::LivelinessQosPolicy().lease_duration;
}

// A reliable sample that got lost, or whose acknowledgement is awaited at the end, waits for the
// next heartbeat; the library's default is 3 s. Set here and not in the profile because Fast
// DDS 2.9 and 3.1 spell <times> differently. Heartbeats go only while something is unacknowledged.
const Duration kHeartbeatPeriod(0, 100'000'000);

// What a writer that is about to be deleted holds, under its lock. Fast DDS releases its samples
// without one, while the writer still has its heartbeats: one that comes meanwhile, which is where
// a reader has not acknowledged all, looks for holes between released samples, and never ends
// (2.9.1 and 3.1).
void ReleaseSamples(dds::DataWriter& writer) {
  std::size_t released = 0;
  writer.clear_history(&released);
}

}  // namespace

dds::DomainParticipantQos ParticipantQos(const LinkOptions& options, const std::string& name) {
  return MakeQos(options, name, false, nullptr);
}

dds::DataWriterQos WriterQos(dds::Publisher& publisher, const std::string& profile,
                             std::int32_t depth) {
  dds::DataWriterQos qos;
  if (!Ok(publisher.get_datawriter_qos_from_profile(profile, qos))) ThrowMissingProfile(profile);
  SetDepth(qos, depth);
  // All of a deep history is taken from the system at once: a world's memory would grow for as long
  // as it fills with events, which in a quiet fleet is hours.
  if (depth != Participant::kProfileDepth) qos.resource_limits().allocated_samples = depth;
  SetHeartbeatPeriod(qos, kHeartbeatPeriod);
  // A reader may ask its writers to filter for it, with an expression of its own: a stranger's
  // would be parsed here, and asked for each sample.
  qos.writer_resource_limits().reader_filters_allocation.maximum = 0;
  return qos;
}

dds::DataReaderQos ReaderQos(dds::Subscriber& subscriber, const std::string& profile,
                             std::int32_t depth) {
  dds::DataReaderQos qos;
  if (!Ok(subscriber.get_datareader_qos_from_profile(profile, qos))) ThrowMissingProfile(profile);
  SetDepth(qos, depth);
  return qos;
}

std::string VehiclePartition(VehicleId vehicle) { return "v" + std::to_string(Number(vehicle)); }

void Participant::DeleteAll::operator()(dds::DomainParticipant* participant) const {
  participant->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

Participant::Participant(const LinkOptions& options, const std::string& name,
                         DiscoveryListener& discovery, Endpoints of_others) {
  CheckOptions(options);
  LoadProfiles(options.qos);
  DiscoveryListener* listener = &discovery;
  if (!options.impairment.rules.empty()) {
    impairer_ = std::make_shared<Impairer>(options.impairment);
    naming_ = std::make_unique<NamingListener>(impairer_, discovery);
    listener = naming_.get();
  }
  listener_ = listener;
  if (of_others == Endpoints::kJudged) listener->KeepEndpoints();
  const dds::DomainParticipantQos qos = MakeQos(options, name, true, impairer_);
  servers_ = ServersOf(qos, options);
  secured_ = IsSecured(qos);
  requests_no_times_ = options.requests_no_times;
  requests_status_once_ = options.requests_status_once;
  if (std::ranges::any_of(qos.transport().user_transports, IsSharedMemory)) memory_.emplace();
  // No status reaches the participant's listener, only discovery: in 2.9.1 an offered deadline
  // missed by a writer without a listener of its own crashes there.
  participant_.reset(dds::DomainParticipantFactory::get_instance()->create_participant(
      options.domain, qos, listener, dds::StatusMask::none()));
  if (participant_ == nullptr) {
    ThrowNotMade("participant in domain " + std::to_string(options.domain) + " on interface " +
                 options.interface +
                 "; are there more than mutation_tries participants on this host?");
  }
  if (impairer_ != nullptr) impairer_->NameOwn(BytesOf(Prefix()));
}

Participant::~Participant() {
  for (const auto& [profile, writer] : writers_) ReleaseSamples(*writer);
}

std::string Participant::WhyNoPeerIsFound() const {
  if (servers_.empty() || listener_->HasFoundAny()) return {};
  constexpr const char* kWhy =
      "no discovery server answers: does fast-discovery-server run there, and does UDP pass in "
      "both directions? (";
  return kWhy + servers_ + ")";
}

std::string Participant::PrefixText() const {
  std::array<std::uint8_t, 16> guid{};
  std::copy_n(Prefix().value, 12, guid.begin());
  return ParticipantText(guid);
}

bool Participant::SharedMemoryIsGone() { return memory_ && memory_->IsGone(LinkNow()); }

std::vector<FoundEndpoint> Participant::TakeFound() {
  std::vector<FoundEndpoint> found = listener_->TakeEndpoints();
  std::erase_if(found, [this](const FoundEndpoint& one) {
    return std::equal(one.guid.begin(), one.guid.begin() + 12, Prefix().value);
  });
  found_.insert(found_.end(), found.begin(), found.end());
  return found;
}

std::vector<std::string> Participant::TakeUnfit(SteadyTime now) {
  TakeFound();
  for (FoundEndpoint& found : found_) unfit_.Add(std::move(found), now);
  found_.clear();
  if (!unfit_.IsDue(now)) return {};
  std::vector<FoundEndpoint> own;
  for (const auto& [profile, writer] : writers_) own.push_back(Described(*writer));
  for (const auto& [profile, reader] : readers_) {
    FoundEndpoint described = Described(*reader);
    const auto topic = read_topics_.find(reader);
    if (topic != read_topics_.end()) described.topic = topic->second;
    own.push_back(std::move(described));
  }
  return unfit_.Check(own, now);
}

dds::Topic& Participant::MakeTopic(const dds::TypeSupport& type, const std::string& topic_name) {
  const std::string name = topic_prefix_ + topic_name;
  if (auto* known = participant_->lookup_topicdescription(name)) {
    return *dynamic_cast<dds::Topic*>(known);
  }
  if (!Ok(type.register_type(participant_.get()))) ThrowNotMade("type " + type.get_type_name());
  auto* topic = participant_->create_topic(name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  if (topic == nullptr) ThrowNotMade("topic " + name);
  return *topic;
}

dds::Publisher& Participant::MakePublisher(const std::string& partition) {
  dds::PublisherQos publisher_qos;
  if (!partition.empty()) publisher_qos.partition().push_back(partition.c_str());
  auto* publisher = participant_->create_publisher(publisher_qos, nullptr, dds::StatusMask::none());
  if (publisher == nullptr) ThrowNotMade("publisher for partition " + partition);
  return *publisher;
}

dds::DataWriter& Participant::MakeWriter(dds::Topic& topic, const std::string& profile,
                                         const std::string& partition, std::int32_t depth) {
  dds::Publisher& publisher = MakePublisher(partition);
  dds::DataWriterQos qos = WriterQos(publisher, profile, depth);
  qos.deadline().period = DeadlineOf(profile, qos.deadline().period);
  auto* writer = publisher.create_datawriter(&topic, qos, nullptr, dds::StatusMask::none());
  if (writer == nullptr) ThrowNotMade("writer of profile \"" + profile + "\"");
  writers_.emplace_back(profile, writer);
  return *writer;
}

dds::DataWriter& Participant::MakeForeignWriter(const dds::TypeSupport& type,
                                                const std::string& topic,
                                                const dds::DataWriterQos& qos) {
  dds::Topic& made = MakeTopic(type, topic);
  auto* writer = MakePublisher("").create_datawriter(&made, qos, nullptr, dds::StatusMask::none());
  if (writer == nullptr) ThrowNotMade("writer of topic \"" + topic + "\"");
  writers_.emplace_back(topic, writer);
  return *writer;
}

void Participant::Delete(dds::DataWriter& writer) {
  std::erase_if(writers_, [&](const auto& made) { return made.second == &writer; });
  // The library shows a writer its publisher only as const; it was made for this writer alone.
  auto* publisher = const_cast<dds::Publisher*>(writer.get_publisher());
  ReleaseSamples(writer);
  publisher->delete_datawriter(&writer);
  participant_->delete_publisher(publisher);
}

dds::TopicDescription& Participant::Filtered(dds::Topic& topic, FilterOfTopic filter) {
  filter.digests = secured_;
  const std::string filter_class = "giveway " + PrefixText();
  if (participant_->lookup_content_filter_factory(filter_class.c_str()) == nullptr &&
      !Ok(participant_->register_content_filter_factory(filter_class.c_str(), &filters_))) {
    ThrowNotMade("filter of samples");
  }
  const std::string expression = filters_.Add(filter);
  auto* filtered = participant_->create_contentfilteredtopic(
      topic.get_name() + " " + expression, &topic, expression, {}, filter_class.c_str());
  if (filtered == nullptr) ThrowNotMade("filter of " + topic.get_name());
  return *filtered;
}

dds::DataReader& Participant::MakeReader(dds::Topic& topic, const std::string& profile,
                                         const std::string& partition, std::int32_t depth,
                                         dds::DataReaderListener* listener,
                                         const dds::StatusMask& mask, const FilterOfTopic& filter) {
  dds::SubscriberQos subscriber_qos;
  subscriber_qos.partition().push_back(partition.c_str());
  auto* subscriber =
      participant_->create_subscriber(subscriber_qos, nullptr, dds::StatusMask::none());
  if (subscriber == nullptr) ThrowNotMade("subscriber for partition " + partition);
  dds::TopicDescription& read = filter.filter == nullptr ? topic : Filtered(topic, filter);
  dds::DataReaderQos qos = ReaderQos(*subscriber, profile, depth);
  qos.deadline().period = DeadlineOf(profile, qos.deadline().period);
  if (requests_no_times_) RequestNoTimes(qos);
  if (requests_status_once_ && profile == TopicOf<wire::Status>::kReader) {
    qos.reliability().kind = dds::BEST_EFFORT_RELIABILITY_QOS;
  }
  auto* reader = subscriber->create_datareader(&read, qos, listener, mask);
  if (reader == nullptr) ThrowNotMade("reader of profile \"" + profile + "\"");
  readers_.emplace_back(profile, reader);
  if (filter.filter != nullptr) read_topics_.emplace(reader, topic.get_name());
  return *reader;
}

}  // namespace giveway::link
